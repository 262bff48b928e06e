"""OpenCL C: runs and is validated on any OpenCL device, PoCL's CPU by choice."""
