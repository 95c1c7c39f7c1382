// Provides: work to keep a GPU busy with, while a benchmark hands it a frame (benchmark/gpu_time.py).

out vec4 f_sum;

void main() {
    f_sum = vec4(0.25);  // added layer upon layer: none may be left out
}
