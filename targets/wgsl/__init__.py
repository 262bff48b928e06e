"""WGSL: runs on WebGPU through wgpu, whose naga validates it."""
