"""Scenes and runs: the numbers of the program, arrays without copies, messages."""

import copy
import gc
import json
import tempfile
import threading
import unittest
from pathlib import Path

import lagroid
import numpy as np
from data import EXAMPLES

PENDULUM = {
    "system": "pendulum",
    "initial": {"position": [0.5], "momentum": np.array([0.2])},
    "time": {"step": 0.1, "steps": 100},
}


class Scenes(unittest.TestCase):
    def test_file_text_and_dict_are_one_scene(self) -> None:
        text = lagroid.scene_text(PENDULUM)
        with tempfile.TemporaryDirectory() as folder:
            file = Path(folder) / "scene.toml"
            file.write_text(text)
            runs = [lagroid.run(scene) for scene in (file, str(file), text, PENDULUM)]
        for run in runs[1:]:
            np.testing.assert_array_equal(run["q"], runs[0]["q"])
        self.assertEqual(runs[0].steps, 100)

    def test_settings_override(self) -> None:
        run = lagroid.run(PENDULUM, set={"time.steps": 7, "parameters": {"gravity": 2.5}, "time.step": np.float64(0.2)})
        self.assertEqual(len(run.time), 8)
        self.assertAlmostEqual(run.time[-1], 1.4)

    def test_a_formula_is_the_system_of_its_class(self) -> None:
        written = PENDULUM | {
            "system": "lagrangian",
            "lagrangian": {"coordinates": ["q"], "l": "m*length^2*q'^2/2 + m*g*length*cos(q)"},
            "parameters": {"m": 2.0, "length": 0.5, "g": 3.0},
            "time": PENDULUM["time"] | {"method": "midpoint"},
        }
        parameters = {"mass": 2.0, "length": 0.5, "gravity": 3.0, "quadrature": "midpoint"}
        run, classes = lagroid.run(written), lagroid.run(PENDULUM, set={"parameters": parameters})
        np.testing.assert_allclose(run["q"], classes["q"], rtol=0, atol=1e-13)
        np.testing.assert_allclose(run["p_q"], classes["p"], rtol=0, atol=1e-13)
        written["lagrangian"]["l"] = "m*length^2*q'^2/2 + foo"
        with self.assertRaisesRegex(lagroid.SceneError, 'lagrangian.l: .*there is no "foo"'):
            lagroid.run(written)

    def test_a_reduced_run_gives_the_full_motion_back(self) -> None:
        scene, settings = EXAMPLES / "kepler.toml", {"time.steps": 100}
        full = lagroid.run(scene, set=settings)
        back = lagroid.run(scene, set=settings, reduce="angular-momentum")
        np.testing.assert_allclose(back["position"], full["position"], rtol=0, atol=1e-11)
        self.assertIn("geometric phase", [entry.name for entry in back.ledger])
        self.assertIn("angular-momentum", [each["name"] for each in lagroid.systems()["kepler"]["reductions"]])
        with self.assertRaisesRegex(lagroid.SceneError, "none of rotations, angular-momentum"):
            lagroid.run(scene, reduce="translations")

    def test_reductions_are_named_and_phases_are_columns(self) -> None:
        by = lagroid.reductions("gyrostat")
        self.assertEqual(by["rotor-momenta"]["groupoid"], "SO(3)")
        self.assertEqual(lagroid.reductions("pendulum"), {})
        with self.assertRaisesRegex(ValueError, "no system 'gyrostats'; those of scenes are .*gyrostat"):
            lagroid.reductions("gyrostats")
        run = lagroid.run(EXAMPLES / "gyrostat.toml", set={"time.steps": 50}, reduce=next(iter(by)))
        self.assertEqual(run["reduced_momentum"].shape, (51, 3))
        dynamic, geometric = run["phases"][:, :3], run["phases"][:, 3:]
        np.testing.assert_array_equal(dynamic[0], 0)
        # Rotors turn by h J^{-1} j - w: the first is what their momenta alone do, the second minus the body's own turns.
        steady = np.diff(dynamic, axis=0)
        np.testing.assert_allclose(steady, np.broadcast_to(steady[0], steady.shape), rtol=0, atol=1e-12)
        self.assertGreater(np.abs(geometric[-1]).max(), 0.1)

    def test_events_are_found_inside_of_steps(self) -> None:
        events = [
            {"name": "bottom", "when": "q"},
            {"name": "out", "when": "abs(q)", "at": "maximum", "then": "stop", "count": 3},
        ]
        run = lagroid.run(PENDULUM, set={"time.steps": 1000}, events=events)
        found = [event["event"] for event in run.events]
        self.assertEqual(found, ["out", "bottom", "out", "bottom", "out"])
        self.assertEqual(run.final.time, run.events[-1]["t"])
        self.assertAlmostEqual(run.events[1]["q"], 0, delta=1e-14)
        np.testing.assert_array_equal(lagroid.run(PENDULUM, events=events[:1])["q"], lagroid.run(PENDULUM)["q"])
        with self.assertRaisesRegex(lagroid.OutputError, 'there is no "height"; there are t, q, p'):
            lagroid.run(PENDULUM, events=[{"name": "high", "when": "height"}])

    def test_events_by_functions(self) -> None:
        seen = []

        def called(node: lagroid.EventNode) -> bool:
            seen.append((node["t"], node["q"]))
            return len(seen) < 3

        by_function = [{"name": "down", "when": lambda node: node["q"] - 0.1, "call": called}]
        run = lagroid.run(PENDULUM, set={"time.steps": 1000}, events=by_function)
        self.assertEqual([event["t"] for event in run.events], [t for t, _ in seen])
        self.assertEqual(run.final.time, seen[2][0])
        by_text = lagroid.run(PENDULUM, set={"time.steps": 1000}, events=[{"name": "down", "when": "q - 0.1"}])
        self.assertEqual([event["t"] for event in by_text.events[:3]], [t for t, _ in seen])
        with self.assertRaisesRegex(ZeroDivisionError, "division"):
            lagroid.run(PENDULUM, events=[{"name": "none", "when": lambda node: 1 / 0}])
        with self.assertRaisesRegex(KeyError, "height; there are t, q, p"):
            lagroid.run(PENDULUM, events=[{"name": "none", "when": lambda node: node["height"]}])
        with self.assertRaisesRegex(ValueError, 'there is no "where"; there are name, when'):
            lagroid.run(PENDULUM, events=[{"name": "none", "when": abs, "where": "q"}])
        kept = []
        lagroid.run(PENDULUM, events=[{"name": "kept", "when": lambda node: kept.append(node) or 1.0}])
        with self.assertRaisesRegex(RuntimeError, "only while its function is called"):
            kept[0]["q"]

    def test_arrays_of_tables(self) -> None:
        run = lagroid.run(EXAMPLES / "chain_drop.toml", set={"time.steps": 2})
        self.assertTrue(run.converged)

    def test_every_example_that_is_short_runs(self) -> None:
        for name in ("rigid_body", "heavy_top", "plate_ball_initial_value", "spherical_pendulum", "pendulum_chain"):
            run = lagroid.require(lagroid.run(EXAMPLES / f"{name}.toml", set={"time.steps": 20}))
            self.assertGreater(len(run.series), 0, name)
            self.assertFalse(any(entry.broken for entry in run.ledger), name)

    def test_columns_are_those_of_the_files(self) -> None:
        with tempfile.TemporaryDirectory() as folder:
            run = lagroid.run(EXAMPLES / "rigid_body.toml", set={"time.steps": 50}, out=folder)
            with open(Path(folder) / "trajectory.csv", encoding="ascii") as file:
                header = file.readline().lstrip("# ").strip().split(",")
            table = np.genfromtxt(Path(folder) / "trajectory.csv", delimiter=",", skip_header=1)
            summary = json.loads((Path(folder) / "summary.json").read_text())
        self.assertEqual(header, run.columns)
        for i, label in enumerate(run.columns):
            values = run[label]
            np.testing.assert_array_equal(table[-len(values) :, i], values)
        self.assertEqual(summary["status"], run.status)
        self.assertEqual(json.loads(run.json())["steps"], 50)

    def test_arrays_are_the_runs_own_numbers(self) -> None:
        run = lagroid.run(PENDULUM)
        first, second = run["q"], run["q"]
        self.assertFalse(first.flags.owndata)
        self.assertFalse(first.flags.writeable)
        self.assertTrue(np.shares_memory(first, second))
        self.assertTrue(np.shares_memory(run.series[0].values, first))
        expected = first.copy()
        del run, second
        gc.collect()
        _ = [lagroid.run(PENDULUM) for _ in range(3)]
        np.testing.assert_array_equal(first, expected)  # the array keeps them alive

    def test_shapes(self) -> None:
        run = lagroid.run(EXAMPLES / "plate_ball_initial_value.toml", set={"time.steps": 10})
        self.assertEqual(run["position"].shape, (11, 2))
        self.assertEqual(run["attitude"].shape, (11, 4))
        self.assertEqual(run["multipliers"].shape, (10, 3))
        self.assertEqual(run["x"].shape, (11,))
        for label in ("x", "position", "t"):
            self.assertIn(label, run)
        self.assertNotIn("nothing", run)
        with self.assertRaises(KeyError):
            run["nothing"]

    def test_without_record(self) -> None:
        run = lagroid.run(PENDULUM, record=False)
        self.assertEqual(run.columns, [])
        self.assertEqual(len(run.final.position), 1)
        with self.assertRaisesRegex(KeyError, "nothing was recorded"):
            run["q"]

    def test_mistakes_are_the_programs_one_line(self) -> None:
        with self.assertRaisesRegex(lagroid.SceneError, 'stepz: unknown key; did you mean "step"') as caught:
            lagroid.run(PENDULUM, set={"time": {"stepz": 1, "steps": 5}})
        self.assertNotIn("\n", str(caught.exception))
        self.assertIsInstance(caught.exception, ValueError)
        with self.assertRaisesRegex(lagroid.SceneError, "no such scene file"):
            lagroid.run("missing.toml")
        with self.assertRaisesRegex(lagroid.SceneError, "time.thing"):
            lagroid.run({"time": {"thing": object()}})
        for text in ["x\n!touch owned", "x\x1b[31m", "x\x7f", "x\x9b", "x\u202e", "x" * 100_000]:
            with self.assertRaisesRegex(lagroid.SceneError, "^--set system: a text") as caught:
                lagroid.run(PENDULUM, set={"system": text})
            self.assertTrue(str(caught.exception).isprintable())
            with self.assertRaisesRegex(lagroid.SceneError, "name: a text"):
                lagroid.run({"name": text})
        with self.assertRaisesRegex(lagroid.SceneError, "no key"):
            lagroid.run({"time.steps": 3})
        with self.assertRaises(lagroid.OutputError):
            lagroid.run(PENDULUM, out="/proc/nowhere")

    def test_a_failed_step_is_a_status_and_an_error(self) -> None:
        run = lagroid.run(
            {
                "system": "plate_ball",
                "initial": {"position": [0, 0], "momentum": [1, 1, 1, 1, 1]},
                "time": {"step": 40.0, "steps": 3},
            }
        )
        self.assertFalse(run.converged)
        with self.assertRaises(lagroid.SolveError) as caught:
            lagroid.require(run)
        self.assertEqual(caught.exception.status, run.status)
        self.assertIs(caught.exception.result, run)
        self.assertIn("step 1", str(caught.exception))

    def test_resume_goes_on_with_the_same_bits(self) -> None:
        with tempfile.TemporaryDirectory() as folder:
            lagroid.run(PENDULUM, out=folder)
            longer = lagroid.resume(folder, steps=150)
            with self.assertRaises(lagroid.OutputError):
                lagroid.resume(Path(folder) / "elsewhere")
            with self.assertRaisesRegex(lagroid.OutputError, "it holds a run of another scene"):
                lagroid.run(PENDULUM, set={"time.steps": 7}, out=folder)
            with self.assertRaisesRegex(lagroid.OutputError, "it holds a run"):
                longer.write(folder)
        np.testing.assert_array_equal(longer["q"], lagroid.run(PENDULUM, set={"time.steps": 150})["q"])

    def test_threads_run_at_once(self) -> None:
        expected = lagroid.run(PENDULUM)["q"].copy()
        found: list[lagroid.RunResult] = []
        threads = [threading.Thread(target=lambda: found.append(lagroid.run(PENDULUM))) for _ in range(8)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        self.assertEqual(len(found), 8)
        for run in found:
            np.testing.assert_array_equal(run["q"], expected)

    def test_the_lock_is_released(self) -> None:
        ticks = 0
        done = threading.Event()

        def long() -> None:
            lagroid.run(PENDULUM, set={"time.steps": 1_000_000}, record=False)
            done.set()

        thread = threading.Thread(target=long)
        thread.start()
        while not done.is_set():
            ticks += 1
        thread.join()
        self.assertGreater(ticks, 1000)

    def test_boundary_value(self) -> None:
        run = lagroid.require(lagroid.run(EXAMPLES / "kepler_boundary.toml"))
        self.assertIsNotNone(run.cost)
        self.assertGreaterEqual(len(run.stationary_paths), 1)
        self.assertEqual(run.stationary_paths[0].momentum.shape, (2,))
        with self.assertWarns(DeprecationWarning):
            self.assertEqual(len(run.minima), len(run.stationary_paths))
        with self.assertWarns(DeprecationWarning):
            self.assertIs(lagroid.Minimum, lagroid.StationaryPath)

    def test_systems_are_those_of_the_listing(self) -> None:
        systems = lagroid.systems()
        self.assertIn("plate_ball", systems)
        self.assertEqual(systems["kepler"]["parameters"][0]["name"], "strength")
        self.assertIn("angular momentum", systems["kepler"]["conserved"])

    def test_a_scene_is_not_changed(self) -> None:
        before = copy.deepcopy(PENDULUM)
        lagroid.run(PENDULUM, set={"time.steps": 3})
        self.assertEqual(lagroid.scene_text(before), lagroid.scene_text(PENDULUM))

    def test_text_of_a_scene(self) -> None:
        text = lagroid.scene_text({"a": True, "b": 'say "x"', "c": {"d": [1, 2.5], "e f": float("inf")}})
        self.assertEqual(text, '"a" = true\n"b" = "say \\"x\\""\n"c" = {"d" = [1, 2.5], "e f" = inf}\n')


if __name__ == "__main__":
    unittest.main()
