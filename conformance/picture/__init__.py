"""Pictures of the library at work: a scene file, one visibility buffer, shaded by any backend."""
