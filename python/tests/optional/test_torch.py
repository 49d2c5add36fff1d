"""Runs as functions that autograd differentiates: their derivatives, what they fit, and what is refused."""

import os
import subprocess
import sys
import unittest
from collections.abc import Callable
from typing import Any
from unittest import mock

import lagroid
import numpy as np
from data import EXAMPLES, gradient_program, without_torch

PENDULUM = EXAMPLES / "pendulum.toml"
SHORT = {"time.steps": 30}

if not without_torch():
    import lagroid.torch
    import torch

    def tensor(values: Any) -> torch.Tensor:
        return torch.tensor(values, dtype=torch.float64, requires_grad=True)

    def gradcheck(function: Callable[..., torch.Tensor], *at: torch.Tensor) -> None:
        torch.autograd.gradcheck(function, at, atol=1e-8, rtol=1e-8)


class Import(unittest.TestCase):
    def test_without_torch_it_says_what_to_install(self) -> None:
        command = "import sys; sys.modules['torch'] = None; import lagroid; import lagroid.torch"
        done = subprocess.run([sys.executable, "-c", command], capture_output=True, text=True, check=False)
        said = "ModuleNotFoundError: lagroid.torch needs PyTorch: apt-get install python3-torch"
        self.assertEqual(done.stderr.strip().splitlines()[-1], said)


class WithProgram(unittest.TestCase):
    """Of scenes of one system."""

    system = "pendulum"

    def setUp(self) -> None:
        if why := without_torch(self.system):
            self.skipTest(why)
        program = mock.patch.dict(os.environ, LAGROID_GRADIENT=gradient_program(self.system))
        program.start()
        self.addCleanup(program.stop)


class Derivatives(WithProgram):
    def test_are_those_of_differences(self) -> None:
        def end(length: torch.Tensor, p: torch.Tensor, mass: torch.Tensor, q: torch.Tensor) -> torch.Tensor:
            # Neither in the order of the scene nor in that of the table of derivatives.
            at = {"parameters.length": length, "initial.momentum": p, "parameters.mass": mass, "initial.position": q}
            return lagroid.torch.observe(PENDULUM, at, of=["final.p", "final.q", "node.3.q", "integral"], set=SHORT)

        gradcheck(end, tensor(1.2), tensor([0.1]), tensor(0.7), tensor([1.0]))

    def test_wrong_ones_are_found_out(self) -> None:
        def end(length: torch.Tensor) -> torch.Tensor:
            return lagroid.torch.observe(PENDULUM, {"parameters.length": length}, set=SHORT)

        def wrong(*asked: Any, **named: Any) -> lagroid.GradientTable:
            table = lagroid.gradient(*asked, **named)
            return table._replace(derivatives=table.derivatives * (1 + 1e-6))

        gradcheck(end, tensor(1.2))
        with mock.patch("lagroid.torch.gradient", wrong):
            with self.assertRaisesRegex(RuntimeError, "Jacobian mismatch"):
                gradcheck(end, tensor(1.2))

    def test_values_and_derivatives_are_those_of_the_table(self) -> None:
        at = {"initial.position": [0.3], "parameters.length": 1.7}
        table = lagroid.gradient(PENDULUM, wrt=list(at), set={**SHORT, **at})
        q, length = tensor(at["initial.position"]), tensor(at["parameters.length"])
        end = lagroid.torch.observe(PENDULUM, {"parameters.length": length, "initial.position": q}, set=SHORT)
        np.testing.assert_array_equal(end.detach(), table.values)
        for i, value in enumerate(end):
            by_q, by_length = torch.autograd.grad(value, (q, length), retain_graph=True)
            np.testing.assert_array_equal([by_q.item(), by_length.item()], table.derivatives[i])
        with torch.no_grad():
            self.assertFalse(lagroid.torch.observe(PENDULUM, {"parameters.length": length}, set=SHORT).requires_grad)

    def test_second_ones_are_refused(self) -> None:
        length = tensor(1.2)
        end = lagroid.torch.observe(PENDULUM, {"parameters.length": length}, set=SHORT)
        (slope,) = torch.autograd.grad(end.square().sum(), length, create_graph=True)
        with self.assertRaisesRegex(NotImplementedError, "^lagroid.torch: runs have first derivatives alone"):
            (slope * length).backward()

    def test_batches_are_their_members(self) -> None:
        starts = tensor(np.linspace(-1, 1, 6).reshape(2, 3, 1))
        lengths = tensor([1.0, 1.1, 1.2])

        def ends(starts: torch.Tensor, lengths: torch.Tensor) -> torch.Tensor:
            at = {"initial.position": starts, "parameters.length": lengths}
            return lagroid.torch.observe(PENDULUM, at, of=["final"], set=SHORT)

        together = ends(starts, lengths)
        self.assertEqual(together.shape, (2, 3, 2))
        for i in range(2):
            for j in range(3):
                alone = ends(starts[i, j], lengths[j])
                np.testing.assert_array_equal(together[i, j].detach(), alone.detach())
        gradcheck(ends, starts, lengths)


class Fits(WithProgram):
    def test_ten_steps_recover_a_length(self) -> None:
        nodes = [f"node.{k}.q" for k in range(0, 41, 5)]

        def angles(length: torch.Tensor) -> torch.Tensor:
            return lagroid.torch.observe(PENDULUM, {"parameters.length": length}, of=nodes, set={"time.steps": 40})

        measured = angles(torch.tensor(1.1, dtype=torch.float64))
        length = tensor(1.5)
        optimiser = torch.optim.LBFGS(
            [length], max_iter=1, line_search_fn="strong_wolfe", tolerance_grad=0, tolerance_change=0
        )

        def misfit() -> torch.Tensor:
            optimiser.zero_grad()
            squares = (angles(length) - measured).square().sum()
            squares.backward()
            return squares

        for _ in range(10):
            optimiser.step(misfit)
        self.assertAlmostEqual(length.item(), 1.1, delta=1e-7)


class Refusals(WithProgram):
    def refused(self, error: type[Exception], why: str, at: Any, of: Any = "final", **named: Any) -> None:
        with self.assertRaisesRegex(error, why):
            lagroid.torch.observe(named.pop("scene", PENDULUM), at, of=of, **named)

    def test_tensors(self) -> None:
        one = tensor(1.0)
        key = "parameters.length"
        self.refused(TypeError, f"^{key}: steps are made in double precision, not in torch.float32;",
                     {key: torch.tensor(1.0)})  # fmt: skip
        self.refused(TypeError, f"^{key}: steps are made by the processor, the tensor is on meta;",
                     {key: torch.zeros((), dtype=torch.float64, device="meta")})  # fmt: skip
        self.refused(TypeError, f"^{key}: expected a tensor, got float; what is not differentiated is for set", {key: 1.0})
        self.refused(ValueError, r"^initial.position: expected shape \(1,\), .* got \(\)", {"initial.position": one})
        self.refused(ValueError, r"^observe: batches of shapes \(2,\), \(3,\) do not broadcast",
                     {key: one.repeat(2), "parameters.mass": one.repeat(3)})  # fmt: skip
        self.refused(ValueError, r"^observe: a batch of shape \(0,\) has no members", {key: one.repeat(0)})
        self.refused(ValueError, "^observe: names no number of the scene", {})

    def test_keys(self) -> None:
        one = tensor(1.0)
        self.refused(lagroid.SceneError, "^parameters.lenght: is not in the scene", {"parameters.lenght": one})
        self.refused(lagroid.SceneError, "^initial.position.1: is not in the scene", {"initial.position.1": one})
        self.refused(lagroid.SceneError, "^parameters.quadrature: is no number", {"parameters.quadrature": one})
        self.refused(lagroid.SceneError, "^time.step: derivatives are by initial.NAME or", {"time.step": one})
        self.refused(lagroid.SceneError, "^final.energy: nothing of that name", {"parameters.mass": one}, "final.energy")
        self.refused(ValueError, "^of: final.p comes after another place; name what is of final together",
                     {"parameters.mass": one}, ["final.q", "node.3", "final.p"])  # fmt: skip

    def test_members_of_a_batch_are_named(self) -> None:
        lengths = {"parameters.length": tensor([1.0, -1.0])}
        self.refused(lagroid.SceneError, "^member 1 of the batch: .*parameters.length: must be positive, got -1", lengths)
        with mock.patch("lagroid.torch.gradient", side_effect=lagroid.SolveError("the step at t = 0 failed")):
            self.refused(lagroid.SolveError, "^member 0 of the batch: the step at t = 0 failed", lengths)
            self.refused(lagroid.SolveError, "^the step at t = 0 failed", {"parameters.length": tensor(1.0)})

    def test_a_start_that_changes_with_parameters(self) -> None:
        sleigh = EXAMPLES / "chaplygin_sleigh.toml"
        self.refused(lagroid.SceneError, "chaplygin_sleigh.toml: initial: a start that is not given by its momentum",
                     {"parameters.mass": tensor(1.0)}, scene=sleigh)  # fmt: skip

    def test_few_digits_are_told(self) -> None:
        def beyond(*asked: Any, **named: Any) -> lagroid.GradientTable:
            return lagroid.gradient(*asked, **named)._replace(growth=1e15, digits_left=0.7)

        with mock.patch("lagroid.torch.gradient", beyond):
            with self.assertWarnsRegex(RuntimeWarning, r"grew 1e\+15 times: of sixteen digits 0.7 are left") as told:
                lagroid.torch.observe(PENDULUM, {"parameters.mass": tensor(1.0)}, set=SHORT)
        self.assertEqual(told.filename, __file__)


class Vectors(WithProgram):
    system = "poisson"

    def test_vectors_of_parameters_and_one_of_their_numbers(self) -> None:
        def end(at: dict[str, torch.Tensor]) -> torch.Tensor:
            return lagroid.torch.observe(EXAMPLES / "euler_top.toml", at, of=["final.state", "node.7.energy"], set=SHORT)

        inertia, state = tensor([1.0, 2.0, 3.0]), tensor([0.3, 1.0, 0.2])
        gradcheck(lambda i, x: end({"parameters.inertia": i, "initial.state": x}), inertia, state)
        gradcheck(lambda i: end({"parameters.inertia.2": i}), tensor(3.0))
        with self.assertRaisesRegex(lagroid.SceneError, "^observe: 4 numbers are given for .*; name each once"):
            end({"parameters.inertia": inertia, "parameters.inertia.2": inertia[2]})


class Constrained(WithProgram):
    system = "spherical_pendulum"

    def test_charts_of_what_is_constrained(self) -> None:
        # Starts stay on the sphere, and tangent to it, as angles, their rates and the length change.
        def end(x: torch.Tensor) -> torch.Tensor:
            a, b, length, u, v = x
            zero = torch.zeros_like(a)
            out = torch.stack([a.sin() * b.cos(), a.sin() * b.sin(), -a.cos()])
            down = torch.stack([a.cos() * b.cos(), a.cos() * b.sin(), a.sin()])
            round_ = torch.stack([-b.sin(), b.cos(), zero])
            at = {
                "initial.position": length * out,
                "initial.momentum": u * down + v * round_,
                "parameters.length": length,
            }
            return lagroid.torch.observe(EXAMPLES / "spherical_pendulum.toml", at, set=SHORT)

        gradcheck(end, tensor([0.7, 0.3, 1.1, 0.4, 1.2]))


if __name__ == "__main__":
    unittest.main()
