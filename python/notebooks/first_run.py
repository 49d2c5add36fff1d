# %% [markdown]
# # A first run
# A scene is a file, a text or a dict; its run holds arrays over its own numbers.

# %%
from pathlib import Path

import lagroid
import numpy as np

examples = Path(__file__).resolve().parents[2] / "examples"
run = lagroid.require(lagroid.run(examples / "kepler.toml", set={"time.steps": 2000}))
print(run.text())

# %% [markdown]
# Columns are those of the files that `lagroid run --out` writes.

# %%
print(run.columns)
print("farthest from the centre:", np.hypot(run["x"], run["y"]).max())

# %% [markdown]
# The ledger says what was promised and what was found.

# %%
for entry in run.ledger:
    print(entry)
assert not any(entry.broken for entry in run.ledger)

# %% [markdown]
# Pictures need no window.

# %%
figure = lagroid.plot.trajectory(run)
print(len(figure.axes), "panels")

# %% [markdown]
# The same motion with other steps: explicit, and of order 8. What accuracy costs, `lagroid.study` measures.

# %%
reference = lagroid.run(examples / "kepler.toml", set={"time.steps": 2000, "time.order": 8})
for order in (2, 4, 6):
    other = lagroid.run(
        examples / "kepler.toml", set={"time.steps": 2000, "time.method": "splitting", "time.order": order}
    )
    print(f"order {order}: {np.abs(other['position'] - reference['position']).max():.1e} in {other.seconds:.1e} s")

# %% [markdown]
# A mistake in a scene is one line.

# %%
try:
    lagroid.run(examples / "kepler.toml", set={"time.stepz": 100})
except lagroid.SceneError as error:
    print(error)
