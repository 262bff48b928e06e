"""Only what a scene needs: one function per target with the parameters that still vary, proven and reported.

```
SCENE.toml --document--> Scene --general--> one IR function over all lights (the reference of everything)
   general --specialise--> exact --search--> candidates within the budget --prove--> drivers --write--> files
```
"""
