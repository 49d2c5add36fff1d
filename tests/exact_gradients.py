#!/usr/bin/env python3
"""Derivatives of exact flows, by steps that are extrapolated, against those of 256-bit arithmetic (exact-gradients.json): exact_gradients.py BIN DATA.

BIN holds parts/NAME/lagroid-gradient.
"""
import json
import math
import pathlib
import subprocess
import sys
import tempfile
import unittest

import numpy as np

programs, data = (pathlib.Path(word).resolve() for word in sys.argv[1:3])
within = 1e-9  # of the largest entry of a derivative's row
extrapolated = 'method = "extrapolation"\ntolerance = 1e-14\n'


def case(name):
    return next(each for each in json.loads((data / "exact-gradients.json").read_text())["cases"] if each["id"] == name)


def numbers(nested):
    return np.array([numbers(each) for each in nested]) if isinstance(nested, list) else float(nested)


def gradients(part, scene, of, wrt):
    """Values, and derivatives as a matrix, with the names of its columns."""
    with tempfile.TemporaryDirectory() as folder:
        file = pathlib.Path(folder) / "scene.toml"
        file.write_text(scene)
        told = subprocess.run([programs / "parts" / part / "lagroid-gradient", file, "--of", of, "--wrt", wrt, "--json"],
                              capture_output=True, text=True, timeout=120)
    assert told.returncode == 0, told.stdout + told.stderr
    found = json.loads(told.stdout)
    return np.array(found["values"]), np.array(found["derivatives"]), found["by"]


class ExactGradients(unittest.TestCase):
    def near(self, found, expected):
        expected = numbers(expected)
        self.assertEqual(found.shape, expected.shape)
        size = np.abs(expected).max(axis=-1, keepdims=True)
        self.assertLess((np.abs(found - expected) / size).max(), within)

    def test_of_a_pendulum(self):
        of = case("C-pendulum")["continuous"]
        scene = 'system = "pendulum"\n[parameters]\nmass = 1.0\nlength = 1.0\ngravity = 9.81\n[initial]\nposition = [1.0]\nmomentum = [0.5]\n'
        end, found, _ = gradients("pendulum", scene + "[time]\n" + extrapolated + "step = 0.1\nsteps = 20\n", "final",
                                  "initial,parameters.mass,parameters.length,parameters.gravity")
        self.near(end, of["final"])
        self.near(found, of["jacobian"])

    def test_of_keplers_problem(self):
        of = case("C-kepler")["continuous"]
        scene = 'system = "kepler"\n[parameters]\nstrength = 1.0\n[initial]\nposition = [0.7, 0.0]\nmomentum = [0.0, 1.3]\n'
        end, found, _ = gradients("kepler", scene + "[time]\n" + extrapolated + "step = 0.1\nsteps = 40\n", "final",
                                  "initial,parameters.strength")
        self.near(end, of["final"])
        self.near(found, [[*row[:4], row[5]] for row in of["jacobian"]])  # of a body of mass one

    def test_of_a_free_body(self):
        of = case("C-rigidbody")["continuous"]
        scene = 'system = "rigid_body"\n[parameters]\ninertia = [1.0, 2.0, 3.0]\n[initial]\nmomentum = [0.8, 0.6, 1.1]\n'
        for method in (extrapolated, 'method = "moser-veselov"\norder = 10\n'):
            end, found, _ = gradients("rigid_body", scene + "[time]\n" + method + "step = 0.05\nsteps = 80\n",
                                      "final.momentum,final.configuration", "initial.momentum,parameters")
            self.near(end[:3], of["M"])
            self.near(found[:3], of["jacobian_M"])
            attitude = end[3:].reshape(3, 3).T  # column by column
            self.near(attitude, of["R"])
            turns = []
            for column in found[3:].T:
                turn = attitude.T @ column.reshape(3, 3).T
                turns.append([turn[2, 1], turn[0, 2], turn[1, 0]])
            self.near(np.array(turns).T, of["jacobian_R_body"])

    def test_of_heavy_tops(self):
        for name, steps in (("C-heavytop-asym", 30), ("C-heavytop-lagrange", 40)):
            with self.subTest(name):
                given = case(name)
                of, params = given["continuous"], given["params"]
                strength, arm = float(params["mgl"]), numbers(params["chi"])
                start = [*numbers(given["initial"]["M"]), *numbers(given["initial"]["Gamma"])]
                scene = (f'system = "heavy_top_bracket"\n[parameters]\ninertia = {numbers(params["I"]).tolist()}\n'
                         f'weight = {(strength * arm).tolist()}\n[initial]\nstate = {[float(x) for x in start]}\n')
                end, found, by = gradients("poisson", scene + "[time]\n" + extrapolated + f"step = 0.1\nsteps = {steps}\n", "final.state",
                                           "initial,parameters.inertia,parameters.weight")
                self.assertEqual(len(by), 12)
                weights = found[:, 9:]
                self.near(end, [*of["M"], *of["Gamma"]])
                self.near(np.column_stack([found[:, :9], weights @ arm, weights * strength]), of["jacobian"])

    def test_of_a_chain_of_two_pendula(self):
        given = case("C-chain2")
        of = given["continuous"]
        q, w = numbers(given["initial"]["q"]), numbers(given["initial"]["omega"])
        theta, phi = [math.acos(x[2]) for x in q], [math.atan2(x[1], x[0]) for x in q]
        scene = ('system = "pendulum_chain"\n[parameters]\nmasses = [1.0, 1.0]\nlengths = [1.0, 1.0]\ngravity = 9.81\n[initial]\n'
                 f"theta = {theta}\nphi = {phi}\nangular_velocities = {w.tolist()}\nproject_velocities = true\n"
                 "[time]\nstep = 0.05\nsteps = 30\n" + extrapolated)
        end, found, by = gradients("spheres", scene, "final.direction,final.angular_velocity", "initial,parameters")
        self.near(end, [*of["q1"], *of["q2"], *of["omega1"], *of["omega2"]])
        column = dict(zip(by, found.T))
        columns = []
        frames = [(np.array([math.cos(t) * math.cos(p), math.cos(t) * math.sin(p), -math.sin(t)]),
                   np.array([-math.sin(p), math.cos(p), 0])) for t, p in zip(theta, phi)]
        # A turn about an axis, of the rod and of its angular velocity: along south and east, and about the rod.
        for i, (south, east) in enumerate(frames):
            about_rod = np.cross(q[i], w[i])
            for axis in np.eye(3):
                moved = np.cross(axis, q[i])
                columns.append(moved @ south * column[f"initial.q{i + 1}.south"] + moved @ east * column[f"initial.q{i + 1}.east"]
                               + axis @ q[i] * (about_rod @ south * column[f"initial.w{i + 1}.south"]
                                                + about_rod @ east * column[f"initial.w{i + 1}.east"]))
        for i, (south, east) in enumerate(frames):
            for axis in np.eye(3):
                columns.append(axis @ south * column[f"initial.w{i + 1}.south"] + axis @ east * column[f"initial.w{i + 1}.east"])
        for name in ("masses.0", "masses.1", "lengths.0", "lengths.1", "gravity"):
            columns.append(column[f"parameters.{name}"])
        self.near(np.column_stack(columns), of["jacobian"])


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
