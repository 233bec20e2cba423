"""Searches for the best grasp, ours beside those of scipy and pygmo, and Descartes' ladder graph beside ours on one path.

    python benchmarks/structure/run_searches.py [--runs 20] [--baselines FOLDER] [--write]

All searches get the same evaluations (1530, P2's) of the same problems as `mmgrasp reproduce p2-table-3.7`: a section, how far
along it (as a share), an angle and a flip. scipy's differential evolution and pygmo's extended ant colony and harmony search
take whole numbers themselves; dual annealing and CMA-ES get them relaxed and rounded. Infeasible grasps cost 1000 for each
violation, since these searches know no rules of comparison.
"""

from __future__ import annotations

import argparse
import itertools
import statistics
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path

import numpy as np

import mmgrasp as mg
from mmgrasp.grasping import ObjectPathEvaluator
from mmgrasp.problems.pipe_cells import FINGERS, pipe_robot, pipe_structures
from mmgrasp.reproduce.grasp_search_runs import BUDGET, PIPES, WITHIN, optimum, options_of, path_problem, search

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))
from programs import BUILD, baselines_environment, packages_of
from tables import markdown, show

LARGE = 1000.0


class Counted:
    """Cost of a point; remembers the best one and when it came within 0.1 % of the optimum."""

    def __init__(self, pipe: str, target: float):
        self.pipe = pipe_structures()[PIPES[pipe] - 1]
        self.evaluator = ObjectPathEvaluator(path_problem(pipe), check_edges=False)
        self.gripper = pipe_robot("kr6like")[2]
        self.margin = self.gripper.finger_width / 2
        self.target, self.count, self.best = target, 0, np.inf
        self.found: int | None = None

    def __call__(self, x: np.ndarray) -> float:
        if self.count >= BUDGET:
            return LARGE * LARGE
        self.count += 1
        section = int(np.clip(round(float(x[0])), 0, len(self.pipe.sections) - 1))
        room = self.pipe.lengths[section] - 2 * self.margin
        at = self.margin + float(np.clip(x[1], 0, 1)) * room
        grasp = self.pipe.grasp(section, at, float(x[2]), bool(round(float(x[3]))), gripper=self.gripper)
        result = self.evaluator.evaluate(grasp)
        cost = result.cost if result.outcome == mg.Outcome.solved else LARGE * (1 + result.violation)
        self.best = min(self.best, cost)
        if self.found is None and cost <= self.target:
            self.found = self.count
        return cost

    @property
    def bounds(self) -> list[tuple[float, float]]:
        return [(0, len(self.pipe.sections) - 1), (0, 1), (-np.pi, np.pi), (0, 1)]


def scipy_ways() -> dict[str, Callable[[Counted, int], None]]:
    from scipy.optimize import differential_evolution, dual_annealing

    def evolution(cost: Counted, seed: int) -> None:
        differential_evolution(
            cost,
            cost.bounds,
            integrality=[True, False, False, True],
            maxiter=BUDGET // 60 - 1,
            polish=False,
            tol=0,
            rng=seed,
        )

    def annealing(cost: Counted, seed: int) -> None:
        dual_annealing(cost, cost.bounds, maxfun=BUDGET, rng=seed)

    return {"scipy differential evolution": evolution, "scipy dual annealing": annealing}


def pygmo_ways() -> dict[str, Callable[[Counted, int], None]]:
    import pygmo

    def way(make: Callable[[int], object], whole: bool, population: int) -> Callable[[Counted, int], None]:
        def run(cost: Counted, seed: int) -> None:
            order = [1, 2, 0, 3]  # pygmo wants whole numbers last

            class Problem:
                def fitness(self, x):
                    return [cost(np.asarray(x)[np.argsort(order)])]

                def get_bounds(self):
                    low, high = zip(*(cost.bounds[k] for k in order), strict=True)
                    return list(low), list(high)

                def get_nix(self):
                    return 2 if whole else 0

            group = pygmo.population(pygmo.problem(Problem()), population, seed=seed)
            pygmo.algorithm(make(seed)).evolve(group)

        return run

    rounds = BUDGET // 63 + 1
    return {
        "pygmo gaco": way(lambda s: pygmo.gaco(gen=rounds, ker=63, seed=s), True, 63),
        "pygmo ihs": way(lambda s: pygmo.ihs(gen=BUDGET, seed=s), True, 30),
        "pygmo cmaes, relaxed": way(lambda s: pygmo.cmaes(gen=BUDGET // 20, force_bounds=True, seed=s), False, 20),
    }


def searches_table(runs: int, folder: Path) -> str:
    python = baselines_environment(folder, HERE / "search_baselines.txt")
    sys.path.append(packages_of(python))
    others = {**scipy_ways(), **pygmo_ways()}
    rows = []
    for pipe in PIPES:
        known = optimum(pipe, seed=1, boxes=1_000_000, evaluations=30_000, threads=1)
        target = (1 + WITHIN) * known["cost"]
        gap = 100 * (1 - known["lower bound"] / known["cost"])
        rows.append(
            [pipe, "branch_and_bound (threads 1)", f"{known['boxes']} boxes", f"{known['seconds']:.1f} s"]
            + [f"none below {known['lower bound']:.4f} (gap {gap:.2f} %)", f"{known['cost']:.4f}"]
        )
        for method in ("Str3", "GA", "PSO"):
            found, seconds, best = [], [], []
            for seed in range(1, runs + 1):
                begun = time.perf_counter()
                result = search(pipe, max_evaluations=BUDGET, seed=seed, target=target, **options_of(method, 7))
                seconds.append(time.perf_counter() - begun)
                best.append(result.path.cost if result.grasp is not None else np.inf)
                if best[-1] <= target:
                    found.append(result.evaluations)
            rows.append(_row(pipe, f"ours, {method}, setting 7", runs, found, seconds, best))
        for name, way in others.items():
            found, seconds, best = [], [], []
            for seed in range(1, runs + 1):
                cost = Counted(pipe, target)
                begun = time.perf_counter()
                way(cost, seed)
                seconds.append(time.perf_counter() - begun)
                best.append(cost.best)
                if cost.found is not None:
                    found.append(cost.found)
            rows.append(_row(pipe, name, runs, found, seconds, best))
    head = [
        "pipe",
        "search",
        "found the optimum",
        "time, median",
        "evaluations until then, median",
        "best cost, median",
    ]
    return markdown(head, rows)


def _row(pipe: str, name: str, runs: int, found: list[int], seconds: list[float], best: list[float]) -> list[str]:
    until = f"{statistics.median(found):.0f}" if found else "-"
    return [
        pipe,
        name,
        f"{len(found)} of {runs}",
        f"{statistics.median(seconds):.2f} s",
        until,
        f"{statistics.median(best):.4f}",
    ]


def ladder(arm: mg.JointGroup, world: mg.World, poses: np.ndarray) -> float | None:
    """Descartes' ladder graph: a rung for each free configuration at each pose, Euclidean edges, the cheapest way up."""
    rungs = [arm.ik_all(T, 64, world=world, all_turns=True) for T in poses]
    if not all(len(rung) for rung in rungs):
        return None
    cost = np.zeros(len(rungs[0]))
    for last, rung in itertools.pairwise(rungs):
        cost = (cost[:, None] + np.linalg.norm(last[:, None] - rung[None], axis=2)).min(axis=0)
    return float(cost.min())


def ladder_table() -> str:
    rows = []
    for pipe in PIPES:
        problem = path_problem(pipe)
        structure = pipe_structures()[PIPES[pipe] - 1]
        _, arm, gripper = pipe_robot("kr6like")
        options = {"motion_weight": 1.0, "deflection_weight": 0.0, "manipulability_weight": 0.0}
        ratios, ours, theirs = [], [], []
        for grasp in structure.sample_grasps(300, gripper=gripper, seed=5):
            evaluator = ObjectPathEvaluator(problem, check_edges=False, **options)
            begun = time.perf_counter()
            result = evaluator.evaluate(grasp)
            took = time.perf_counter() - begun
            if result.outcome != mg.Outcome.solved:
                continue
            held = arm.with_reference(gripper.joint_values(grasp.opening))
            world = problem.world.copy()
            world.add("pipe", structure.shapes(), problem.T_world_object[0])
            world.attach("pipe", "gripper_tcp", np.linalg.inv(grasp.T_object_hand), set(FINGERS))
            begun = time.perf_counter()
            found = ladder(held, world, problem.T_world_object @ grasp.T_object_hand)
            theirs.append(time.perf_counter() - begun)
            ours.append(took)
            if found is not None:
                ratios.append(result.joint_motion / found)
        rows.append(
            [pipe, str(len(ratios)), f"{min(ratios):.6f} to {max(ratios):.6f}", f"{sum(r < 1.000001 for r in ratios)}"]
            + [f"{1e3 * statistics.median(ours):.2f} ms", f"{1e3 * statistics.median(theirs):.1f} ms"]
        )
    head = [
        "pipe",
        "feasible grasps",
        "our joint motion over the ladder's",
        "the same",
        "ours",
        "ladder, through Python",
    ]
    return markdown(head, rows)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--runs", type=int, default=20)
    parser.add_argument("--baselines", type=Path, default=BUILD / "search-baselines")
    parser.add_argument("--write", action="store_true")
    args = parser.parse_args()
    text = f"Searches of {BUDGET} evaluations, {args.runs} runs each:\n\n"
    try:
        text += searches_table(args.runs, args.baselines)
    except subprocess.CalledProcessError as error:
        text += f"skipped: scipy and pygmo could not be installed ({error})"
    text += "\n\nLeast joint motion of one grasp, beside a ladder graph as Descartes makes it (no bound on jumps, motions between poses not checked):\n\n"
    show("grasp_searches", text + ladder_table(), args.write)


if __name__ == "__main__":
    main()
