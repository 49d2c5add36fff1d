# %% [markdown]
# # Many runs at once
# Runs release the interpreter's lock: threads of Python run them side by side. Here, where a damped, driven pendulum
# ends for a grid of starts. (Sweeps from the command line: docs/python.md.)

# %%
import itertools
import os
from concurrent.futures import ThreadPoolExecutor

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
