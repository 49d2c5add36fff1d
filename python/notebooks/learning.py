# %% [markdown]
# # Learning a Hamiltonian
# From short pieces of a pendulum's motion on T*S^2: mass and potential of H = p^T M(q)^{-1} p / 2 + V(q).

# %%
import lagroid
import numpy as np

data = lagroid.trajectories(count=100, points=5, duration=0.2, seed=1)
print(len(data), "trajectories", data.states.shape)

# %% [markdown]
# V a polynomial of degree one has the truth in it; a network has not, and comes close.

# %%
models = {name: lagroid.learn(data, name, starts=2, iterations=40) for name in ("polynomial:1", "network:4")}
for model in models.values():
    print(model)

# %% [markdown]
# On motions that it has not seen, ten times as long:

# %%
held_out = lagroid.trajectories(count=20, points=5, duration=2.0, seed=2)
for name, model in models.items():
    measures = model.measure(held_out)
    print(name, "error at the end", measures.rms[-1])
exact = models["polynomial:1"]
assert exact.measure(held_out).rms[-1] < 1e-4
assert np.allclose(exact.mass, [[1.0]], atol=1e-4)
