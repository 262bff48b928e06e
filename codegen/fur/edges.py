"""Edges of a surface with the two faces that decide whether a fin shows."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from codegen.fur.surface import Doubles, Integers, Surface, face_normals


@dataclass(frozen=True)
class Edges:
    """Every edge once.

    vertices  (E, 2) numbers of its ends, as its first face runs through them
    face_a    (E, 3) normal of its first face
    face_b    (E, 3) normal of the other face: at the border of an open mesh -face_a, so that the fin always
              shows; where more than two faces meet, the one that differs most from the first
    border    how many edges have one face
    crowded   how many have more than two
    """

    vertices: Integers
    face_a: Doubles
    face_b: Doubles
    border: int
    crowded: int


def find_edges(surface: Surface) -> Edges:
    """The edges of a surface, in the order in which its triangles first name them."""
    normals = face_normals(surface.positions, surface.triangles)
    half = surface.triangles[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2)
    _, first, group, count = np.unique(
        np.sort(half, axis=1), axis=0, return_index=True, return_inverse=True, return_counts=True
    )
    group = group.reshape(-1)
    owner = np.repeat(np.arange(len(surface.triangles)), 3)
    face_a = normals[owner[first]]
    # Of the faces at an edge, the one whose normal is farthest from the first one's.
    apart = np.sum(normals[owner] * face_a[group], axis=1)
    apart[first] = np.inf
    by_edge = np.lexsort((apart, group))
    chosen = by_edge[np.searchsorted(group[by_edge], np.arange(len(first)))]
    face_b = np.where((count > 1)[:, None], normals[owner[chosen]], -face_a)
    order = np.argsort(first)
    return Edges(
        vertices=half[first[order]],
        face_a=face_a[order],
        face_b=face_b[order],
        border=int((count == 1).sum()),
        crowded=int((count > 2).sum()),
    )
