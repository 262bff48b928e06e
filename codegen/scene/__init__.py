"""Only what a scene needs: one function per target with the parameters that still vary, proven and reported.

```
SCENE.toml --document--> Scene --general--> one IR function over all lights (the reference of everything)
   general --specialise--> exact --search--> candidates within the budget --prove--> drivers --write--> files
```

Without drivers, other processes (beside.py) draw the points of the proof, measure the map, and search for
further targets meanwhile; what is written is the same to the byte.
"""
