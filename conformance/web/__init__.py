"""The page of `vair demo web`: what lies in examples/web, with stages, mesh and figures beside it."""
