# SPDX-License-Identifier: GPL-3.0-or-later
"""How drawn surfaces hang on the nodes of their body: at most four nodes and weights for each vertex.

A vertex in a tetrahedron moves with its four nodes by barycentric weights. Joints that only shift give the same:

    x = sum_i w_i (X + u_i) = X + sum_i w_i u_i          X: vertex at rest, u_i: displacements of the nodes

So four joints a vertex, as many as glTF allows, are exact inside the mesh. Vertices that lie a little outside have
weights below 0, which glTF forbids. These are set to 0, and the others are scaled to the sum 1. A vertex that this
moves too far from its place gets a joint of its own (`with_own_joints`).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

SAME = 1e-9  # m: a vertex that is a node
TRIED = 32  # tetrahedra for each vertex
CHUNK = 2_000_000  # pairs of vertex and element at a time


@dataclass(frozen=True)
class Embedding:
    """`joints`: nodes of the body that are used. `indices`: places in `joints`, four for each vertex."""

    joints: np.ndarray
    indices: np.ndarray
    weights: np.ndarray

    def positions(self, rest_vertices: np.ndarray, displacements: np.ndarray) -> np.ndarray:
        """Where the vertices are for displacements of all nodes of the body."""
        u = displacements[self.joints]
        return rest_vertices + np.einsum("vk,vkd->vd", self.weights, u[self.indices])


def _coordinates(points: np.ndarray, rest: np.ndarray, tets: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """For each point the tetrahedron it lies in, or least outside of, and its barycentric coordinates there. Those with
    the nearest middles are tried."""
    origin = rest[tets[:, 0]]
    inverse = np.linalg.inv(np.swapaxes(rest[tets[:, 1:]] - origin[:, None], 1, 2))
    middles, tried = rest[tets].mean(axis=1), min(TRIED, len(tets))
    chosen, coordinates = [], []
    count = max(1, CHUNK // len(tets))
    for first in range(0, len(points), count):
        some = points[first : first + count]
        # The square of the distance less that of the point, which is the same for all middles.
        away = (middles * middles).sum(axis=1) - 2 * some @ middles.T
        near = np.argpartition(away, tried - 1, axis=1)[:, :tried]
        last = np.einsum("pkij,pkj->pki", inverse[near], some[:, None] - origin[near])
        all_four = np.concatenate([1 - last.sum(axis=2, keepdims=True), last], axis=2)
        best = all_four.min(axis=2).argmax(axis=1)
        rows = np.arange(len(best))
        chosen.append(near[rows, best])
        coordinates.append(all_four[rows, best])
    return np.concatenate(chosen), np.concatenate(coordinates)


def _nearest_node(points: np.ndarray, rest: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Index and distance of the nearest node of each point."""
    index, distance = [], []
    count = max(1, CHUNK // len(rest))
    for first in range(0, len(points), count):
        some = points[first : first + count]
        best = ((rest * rest).sum(axis=1) - 2 * some @ rest.T).argmin(axis=1)
        index.append(best)
        distance.append(np.linalg.norm(some - rest[best], axis=1))
    return np.concatenate(index), np.concatenate(distance)


def _triangle_weights(points: np.ndarray, rest: np.ndarray, triangles: np.ndarray, node: np.ndarray):
    """Nodes and weights in the triangle at the nearest node on which the point projects best."""
    nodes = np.zeros((len(points), 4), int)
    weights = np.zeros((len(points), 4))
    for v, p in enumerate(points):
        near = triangles[(triangles == node[v]).any(axis=1)]
        if len(near) == 0:
            nodes[v, 0], weights[v, 0] = node[v], 1
            continue
        a, b, c = (rest[near[:, k]] for k in range(3))
        n = np.cross(b - a, c - a)
        size = (n * n).sum(axis=1)
        w = np.stack([(np.cross(c - b, p - b) * n).sum(axis=1) / size, (np.cross(a - c, p - c) * n).sum(axis=1) / size,
                      (np.cross(b - a, p - a) * n).sum(axis=1) / size], axis=1)
        best = int(w.min(axis=1).argmax())
        nodes[v, :3], weights[v, :3] = near[best], w[best]
    return nodes, weights


def embed(vertices: np.ndarray, rest: np.ndarray, elements: np.ndarray) -> Embedding:
    """Of vertices at rest in a body of tetrahedra, or on one of triangles."""
    node, distance = _nearest_node(vertices, rest)
    nodes = np.repeat(node[:, None], 4, axis=1)
    weights = np.tile([1.0, 0, 0, 0], (len(vertices), 1))
    inner = np.flatnonzero(distance > SAME)
    if len(inner) and len(elements):
        if elements.shape[1] == 4:
            chosen, coordinates = _coordinates(vertices[inner], rest, elements)
            nodes[inner], weights[inner] = elements[chosen], coordinates
        else:
            nodes[inner], weights[inner] = _triangle_weights(vertices[inner], rest, elements, node[inner])
    weights = np.clip(weights, 0, None)
    weights /= weights.sum(axis=1, keepdims=True)
    nodes[weights == 0] = nodes.min()  # the node of an unused place does not matter
    joints, indices = np.unique(nodes, return_inverse=True)
    return Embedding(joints, indices.reshape(nodes.shape), weights)


def with_own_joints(hung: Embedding, vertices: np.ndarray, first: int) -> Embedding:
    """The same with a joint of its own for each of these vertices. Their joints are called `first`, `first` + 1, and so
    on, after all nodes of the body."""
    weights, nodes = hung.weights.copy(), hung.joints[hung.indices]
    nodes[vertices] = (first + np.arange(len(vertices)))[:, None]
    weights[vertices] = (1.0, 0.0, 0.0, 0.0)
    joints, indices = np.unique(nodes, return_inverse=True)
    return Embedding(joints, indices.reshape(nodes.shape), weights)
