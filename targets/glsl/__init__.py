"""GLSL: runs on OpenGL 4.3 compute shaders, is validated by glslang for every dialect."""
