# %% [markdown]
# # Many runs at once
# Runs release the interpreter's lock: threads of Python run them side by side. Here, where a damped, driven pendulum
# ends for a grid of starts.

# %%
import itertools
import os
import tempfile
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import lagroid
import numpy as np

SCENE = """
system = "damped_pendulum"
[parameters]
damping = 0.2
[initial]
position = [0.0]
momentum = [0.0]
[time]
step = 0.05
steps = 600
"""
angles = np.linspace(-3, 3, 9)
momenta = np.linspace(-4, 4, 9)


def well(start: tuple[float, float]) -> int:
    """How often the pendulum went round before it came to rest."""
    q, p = start
    run = lagroid.run(SCENE, set={"initial.position": [q], "initial.momentum": [p]}, record=False)
    return round(float(lagroid.require(run).final.position[0]) / (2 * np.pi))


with ThreadPoolExecutor(os.cpu_count()) as pool:
    wells = np.array(list(pool.map(well, itertools.product(angles, momenta)))).reshape(len(angles), len(momenta))
print(wells)

# %% [markdown]
# The map has the symmetry of the pendulum, (q, p) -> (-q, -p).

# %%
assert (wells == -wells[::-1, ::-1]).all()
assert set(wells.ravel()) >= {-1, 0, 1}

# %% [markdown]
# Thousands of members are the work of the program `lagroid sweep`, which goes on where it was broken off and uses many
# machines: orbits and attractions in a Latin hypercube.

# %%
sweeps = Path(__file__).resolve().parents[2] / "examples" / "sweeps"
with tempfile.TemporaryDirectory() as folder:
    orbits = lagroid.sweep(sweeps / "kepler.toml", out=folder, set={"design.count": 100})
    print(orbits.summary["statuses"], orbits.columns)
    momentum, drift = orbits["initial.momentum.1"], orbits["ledger/energy"]
print("the energy is kept worst where the orbit comes closest, from momentum", momentum[drift.argmax()])
assert len(momentum) == 100 and np.isfinite(drift).all()
