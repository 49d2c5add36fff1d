# %% [markdown]
# # The cheapest way to roll a ball
# A ball on a plate is to be brought from one place and attitude to another, with the least integral of (u^2 + v^2) / 2.
# A boundary value is an arrow too: from the start to the end.

# %%
import sys
from pathlib import Path

import lagroid
import numpy as np

quick = "--full" not in sys.argv
examples = Path(__file__).resolve().parents[2] / "examples"
settings = {"time.steps": 20, "solver.starts": 10} if quick else {}
run = lagroid.require(lagroid.run(examples / "plate_ball.toml", set=settings))
print(run)
print("cost", run.cost)
for path in run.stationary_paths:
    print("  stationary path of cost", path.cost, "a minimum" if path.is_minimum else "no minimum")

# %% [markdown]
# Its path and its controls; the momentum is conserved along it.

# %%
print("from", run["position"][0], "to", run["position"][-1])
print("largest control", np.abs(run["controls"]).max())
assert max(entry.relative_drift for entry in run.ledger if entry.promise == "conserved") < 1e-8

# %% [markdown]
# The same from the system as an object, and integrated onwards from the momentum that the boundary value found.

# %%
ball = lagroid.PlateBall(h=float(run.time[1]), rotation="exp")
path = ball.boundary(ball.arrow([0, 0], [1, 0.5], np.eye(3)), 20, starts=5)[0]
print(path)
trajectory = lagroid.require(ball.integrator(momentum=path.momentum[0], object=path.object[0]).integrate(20))
print("the trajectory ends", np.abs(trajectory.object[-1] - path.object[-1]).max(), "from the path's end")
assert np.allclose(trajectory.object[-1], path.object[-1], atol=1e-6)
