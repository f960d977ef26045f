# SPDX-License-Identifier: Apache-2.0
# %% [markdown]
# # Relief from Python: three plots
#
# Run it as cells in Jupyter, VS Code or Spyder, or as a script: `python3 plots.py bunny.obj`.
# It needs numpy and matplotlib, and writes slice.png, maps.png and budgets.png.

# %% Bake a mesh
import sys

import matplotlib

matplotlib.use("Agg")  # no window; remove this line in a notebook
import matplotlib.pyplot as plt
import numpy as np

import relief

mesh = sys.argv[1] if len(sys.argv) > 1 else "bunny.obj"
collider = relief.bake(mesh, budget=500_000)
low, high = collider.bounds
print(collider, relief.check(collider, mesh, samples=50_000))

# %% A slice of its field
side = 400
x, y = np.meshgrid(np.linspace(low[0], high[0], side), np.linspace(low[1], high[1], side))
points = np.stack([x, y, np.full_like(x, (low[2] + high[2]) / 2)], axis=-1)
distance = collider.query(points.reshape(-1, 3), distance="nearest").distance.reshape(side, side)
reach = 0.08 * (high - low).max()
figure, axes = plt.subplots(figsize=(7, 6), layout="constrained")
picture = axes.imshow(distance, origin="lower", extent=(low[0], high[0], low[1], high[1]), cmap="RdBu", vmin=-reach,
                      vmax=reach)
axes.contour(x, y, distance, levels=[0], colors="black")
axes.set(title="Signed distance, half way through", xlabel="x", ylabel="y")
figure.colorbar(picture, label="distance, mesh units", extend="both")
figure.savefig("slice.png", dpi=120)

# %% Depth maps of the whole mesh. Patches have no image
views = relief.bake(mesh, maps=["front-back:dir=-x", "front-back:dir=-y", "front-back:dir=-z"]).maps
figure, axes = plt.subplots(1, 3, figsize=(9.6, 3.6), layout="constrained")
for one, axis in zip(views, axes):
    axis.imshow(one.depth[0], origin="lower", cmap="viridis")
    axis.set(title=f"map {one.index}: {one.format}\n{one.width} x {one.height}", xticks=[], yticks=[])
figure.suptitle("Depth of the near surface")
figure.savefig("maps.png", dpi=120)

# %% Accuracy against budget
budgets = [32_000, 64_000, 128_000, 256_000, 512_000]
wrong = [relief.check(relief.bake(mesh, budget=b), mesh, samples=50_000).wrong_percent for b in budgets]
figure, axes = plt.subplots(figsize=(6, 4), layout="constrained")
axes.loglog(np.array(budgets) / 1000, wrong, "o-")
axes.set(title="Points near the surface on the wrong side", xlabel="budget, kB", ylabel="%")
axes.set_xticks(np.array(budgets) / 1000, [f"{b // 1000}" for b in budgets])
axes.set_yticks([0.5, 1, 2, 5], ["0.5", "1", "2", "5"])
axes.minorticks_off()
axes.grid(alpha=0.3)
figure.savefig("budgets.png", dpi=120)
