// The self-test: what this browser makes of a clip whose colours are known, and by which decoder.

import { codecOf, decodingFacts } from "./codec.js";

const PATIENCE_MS = 8000;
const FPS = 30;
const LARGEST_BIT_S = 12e6; // of our largest clips

/**
 * Return {codec, is_smooth, is_power_efficient, patches}; rejects where the clip does not play.
 * `size` is that of the study's clips, "1920x1080": decoding is asked for at that size.
 */
export async function selfTest(url, layout, size) {
  const answer = await fetch(url);
  if (!answer.ok) throw new Error(`HTTP-${answer.status}`);
  const clip = new Blob([await answer.arrayBuffer()], { type: "video/mp4" });
  const codec = await codecOf(clip);
  const [width, height] = size.split("x").map(Number);
  const found = await decodingFacts({ codec, width, height, fps: FPS, bitrate: LARGEST_BIT_S });
  const address = URL.createObjectURL(clip);
  const video = document.createElement("video");
  try {
    await firstFrame(video, address);
    return {
      codec,
      is_smooth: found.decoding_smooth,
      is_power_efficient: found.decoding_efficient,
      patches: patchesOf(video, layout),
    };
  } finally {
    video.removeAttribute("src");
    video.load();
    URL.revokeObjectURL(address);
  }
}

function firstFrame(video, address) {
  return new Promise((resolve, reject) => {
    const timer = setTimeout(() => reject(new Error("NO-FRAME")), PATIENCE_MS);
    const seen = () => {
      clearTimeout(timer);
      video.pause();
      resolve();
    };
    video.muted = true;
    video.playsInline = true;
    video.addEventListener("error", () => reject(new Error("DECODE")), { once: true });
    if (video.requestVideoFrameCallback) video.requestVideoFrameCallback(seen);
    else video.addEventListener("timeupdate", seen, { once: true });
    video.src = address;
    video.play().catch(reject);
  });
}

/** The mean colour of every square's middle: at its border chroma is shared with the next. */
function patchesOf(video, { count, patch_px, columns }) {
  const canvas = document.createElement("canvas");
  canvas.width = video.videoWidth;
  canvas.height = video.videoHeight;
  const context = canvas.getContext("2d", { colorSpace: "srgb", willReadFrequently: true });
  context.drawImage(video, 0, 0);
  const inset = patch_px / 4;
  const side = patch_px / 2;
  return Array.from({ length: count }, (_, index) => {
    const x = (index % columns) * patch_px + inset;
    const y = Math.floor(index / columns) * patch_px + inset;
    const { data } = context.getImageData(x, y, side, side);
    const sums = [0, 0, 0];
    for (let i = 0; i < data.length; i += 4) for (const k of [0, 1, 2]) sums[k] += data[i + k];
    return sums.map((sum) => Math.round((100 * sum) / (side * side)) / 100);
  });
}
