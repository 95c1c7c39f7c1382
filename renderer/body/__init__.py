"""Human bodies as data: MakeHuman's meshes and rigs, finer and coarser meshes of them."""
