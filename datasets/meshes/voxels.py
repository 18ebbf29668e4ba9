#!/usr/bin/env python3
"""Writes the meshes that are made of unit cubes: voxels.py FOLDER. Faces lie in planes, edges are
parallel: ties everywhere. Needed only to make the files anew."""
import sys

SIDES = {
    (1, 0, 0): ((1, 0, 0), (1, 1, 0), (1, 1, 1), (1, 0, 1)),
    (-1, 0, 0): ((0, 0, 0), (0, 0, 1), (0, 1, 1), (0, 1, 0)),
    (0, 1, 0): ((0, 1, 0), (0, 1, 1), (1, 1, 1), (1, 1, 0)),
    (0, -1, 0): ((0, 0, 0), (1, 0, 0), (1, 0, 1), (0, 0, 1)),
    (0, 0, 1): ((0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1)),
    (0, 0, -1): ((0, 0, 0), (0, 1, 0), (1, 1, 0), (1, 0, 0)),
}


def write(path, cells):
    number, vertices, faces = {}, [], []
    for cell in sorted(cells):
        for side, corners in SIDES.items():
            if tuple(c + s for c, s in zip(cell, side)) in cells:
                continue
            quad = []
            for corner in corners:
                place = tuple(c + k for c, k in zip(cell, corner))
                if place not in number:
                    number[place] = len(vertices) + 1
                    vertices.append(place)
                quad.append(number[place])
            faces += [(quad[0], quad[1], quad[2]), (quad[0], quad[2], quad[3])]
    with open(path, "w") as out:
        out.writelines("v %d %d %d\n" % v for v in vertices)
        out.writelines("f %d %d %d\n" % f for f in faces)


def box(x, y, z, at=(0, 0, 0)):
    return {(at[0] + i, at[1] + j, at[2] + k) for i in range(x) for j in range(y) for k in range(z)}


folder = sys.argv[1]
comb = box(39, 2, 3)
for tooth in range(20):
    comb |= box(1, 10, 3, (2 * tooth, 2, 0))
write(folder + "/comb.obj", comb)
write(folder + "/bowl.obj", box(20, 20, 20) - box(16, 18, 16, (2, 2, 2)))
islands = set()
for i in range(4):
    for j in range(4):
        islands |= box(2, 2, 2, (4 * i, 4 * j, 3 * ((i + j) % 2)))
write(folder + "/islands.obj", islands)
letter = box(12, 3, 3, (0, 12, 0)) | box(3, 12, 3, (5, 0, 0))
write(folder + "/flat-t.obj", letter)
write(folder + "/box.obj", box(2, 3, 6))
