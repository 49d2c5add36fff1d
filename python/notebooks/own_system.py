# %% [markdown]
# # A system of your own
# A discrete Lagrangian L(q0, q1), written in Python and integrated by a numeric Newton iteration: a bead on a wire bent to
# the parabola y = x^2 / 2. Compiled, in python/template/my_system.cpp, it is a thousand times as fast and more.

# %%
from typing import Any

import lagroid
import numpy as np


class Bead(lagroid.DiscreteLagrangian):
    groupoid = lagroid.Pairs(1)
    h = 0.05

    def lagrangian(self, q0: Any, q1: Any) -> Any:
        y0, y1 = q0**2 / 2, q1**2 / 2
        return (((q1 - q0) ** 2 + (y1 - y0) ** 2) / (2 * self.h) - self.h * (y0 + y1) / 2)[0]


trajectory = Bead().integrator(momentum=[1.0], object=[0.0]).integrate(400)
assert trajectory.converged, trajectory.message


# %% [markdown]
# Variational steps keep the energy within a band that shrinks with the square of the step, and never drift.


# %%
def energy(x: Any, p: Any) -> Any:
    return p**2 / (2 * (1 + x**2)) + x**2 / 2


bands = []
for h in (0.1, 0.05):
    found = Bead(h=h).integrator(momentum=[1.0], object=[0.0]).integrate(round(20 / h))
    bands.append(float(np.ptp(energy(found.object[:, 0], found.momentum[:, 0]))))
print("energy bands:", bands)
assert 3 < bands[0] / bands[1] < 5

# %% [markdown]
# On a group the arrow is a matrix: a rigid body whose kinetic energy is measured in the ambient space, as Moser and
# Veselov do, L(g) = -Tr(g J) / h.


# %%
class MoserVeselov(lagroid.DiscreteLagrangian):
    groupoid = lagroid.SO3()
    h = 0.05
    inertia = np.array([1.0, 2.0, 2.5])

    def lagrangian(self, g: Any) -> Any:
        return -np.trace(g @ np.diag(self.inertia.sum() / 2 - self.inertia)) / self.h


body = MoserVeselov().integrator(momentum=[1.0, 0.1, 0.5])
turning = body.integrate(100)
assert turning.converged, turning.message
(attitudes,) = turning.configuration
spatial = np.einsum("kij,kj->ki", attitudes, turning.momentum)
print("spatial momentum kept to", np.abs(spatial - spatial[0]).max())
assert np.abs(spatial - spatial[0]).max() < 1e-12
