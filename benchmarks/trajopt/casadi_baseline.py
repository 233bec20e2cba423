"""The same problem written for casadi: (4.1)-(4.9) with v and omega for the base, eight-point quadrature, same limits, same rotation
error, and Ipopt with the barrier, tolerances and linear solver's settings that our own solve has.

Built once per number of intervals, with the grasp as a parameter; only the solve is timed. Kinematics are taken over from the
group: fixed transforms between its joints, found from two configurations of each.
"""

from __future__ import annotations

import casadi as ca
import numpy as np

import mmgrasp as mg

NODES, WEIGHTS = np.polynomial.legendre.leggauss(8)
NODES, WEIGHTS = (NODES + 1) / 2, WEIGHTS / 2
IPOPT = {
    "print_level": 0, "sb": "yes", "max_iter": 150, "tol": 1e-4, "constr_viol_tol": 2.5e-9, "mu_strategy": "monotone", "mu_init": 1e-2,
    "mu_min": 1e-6, "acceptable_tol": 1e-2, "acceptable_constr_viol_tol": 2.5e-9, "acceptable_iter": 5, "bound_relax_factor": 0.0,
    "mumps_scaling": 0, "mumps_permuting_scaling": 0, "min_refinement_steps": 0,
}  # fmt: skip


class Baseline:
    def __init__(self, group: mg.robot.JointGroup):
        self.group = group
        self.n = len(group.names)
        self.axes, self.points = self._screws()
        self.solvers: dict[tuple[int, ...], tuple] = {}

    def _screws(self):
        """Axis and a point of each arm joint with the robot at zero, from the Jacobian (product of exponentials)."""
        zero = np.zeros(self.n)
        J, tip = np.asarray(self.group.jacobian(zero)), self.group.fk(zero)
        axes = [J[3:, i] for i in range(3, self.n)]
        points = [tip[:3, 3] + np.cross(J[3:, i], J[:3, i]) for i in range(3, self.n)]
        return axes, points

    def fk(self, q):
        """Rotation and position of the tip: screws from the tip inwards, then the base."""
        tip = self.group.fk(np.zeros(self.n))
        R, p = ca.DM(tip[:3, :3]), ca.DM(tip[:3, 3])
        for i in reversed(range(self.n - 3)):
            w, at = self.axes[i], self.points[i]
            K = np.array([[0, -w[2], w[1]], [w[2], 0, -w[0]], [-w[1], w[0], 0]])
            E = ca.DM.eye(3) + ca.sin(q[3 + i]) * ca.DM(K) + (1 - ca.cos(q[3 + i])) * ca.DM(K @ K)
            R, p = E @ R, E @ (p - ca.DM(at)) + ca.DM(at)
        c, s = ca.cos(q[2]), ca.sin(q[2])
        Z = ca.vertcat(ca.horzcat(c, -s, 0), ca.horzcat(s, c, 0), ca.horzcat(0, 0, 1))
        return Z @ R, Z @ p + ca.vertcat(q[0], q[1], 0)

    def turned(self, q, G):
        """Twice the vector part of the unit quaternion from the target's rotation (a quaternion, w first) to the tip's: 0 at the target alone."""

        def product(a, b):
            v = a[0] * b[1:] + b[0] * a[1:] + ca.cross(a[1:], b[1:])
            return ca.vertcat(a[0] * b[0] - ca.dot(a[1:], b[1:]), v)

        def about(axis, angle):
            return ca.vertcat(ca.cos(angle / 2), ca.sin(angle / 2) * ca.DM(axis))

        x, y, z, w = mg.robot.quat_xyzw_from_rotation(self.group.fk(np.zeros(self.n))[:3, :3])
        at = ca.DM([w, x, y, z])
        for i in reversed(range(self.n - 3)):
            at = product(about(self.axes[i], q[3 + i]), at)
        at = product(about([0.0, 0.0, 1.0], q[2]), at)
        return 2 * product(ca.vertcat(G[0], -G[1:]), at)[1:]

    def _solver(self, intervals: tuple[int, ...]):
        if intervals in self.solvers:
            return self.solvers[intervals]
        n, N, d = self.n, sum(intervals) + 1, self.n - 1
        Q, U, A = ca.SX.sym("Q", n, N), ca.SX.sym("U", d, N), ca.SX.sym("A", d, N - 1)
        H, G, turn = ca.SX.sym("H", len(intervals)), ca.SX.sym("G", 4, 4), ca.SX.sym("turn", 4)
        group, limits = self.group, self.group.robot.base_limits
        velocity = np.concatenate([[limits["linear_velocity"], limits["angular_velocity"]], group.velocity_limits[3:]])
        acceleration = np.concatenate(
            [[limits["linear_acceleration"], limits["angular_acceleration"]], group.acceleration_limits[3:]]
        )
        segment = [s for s, count in enumerate(intervals) for _ in range(count)]
        g, low, high = [], [], []

        def add(expression, lower, upper):
            g.append(expression)
            rows = expression.numel()
            low.extend(np.broadcast_to(lower, rows))
            high.extend(np.broadcast_to(upper, rows))

        for i in range(N - 1):
            h = H[segment[i]]
            add(U[:, i + 1] - U[:, i] - h * A[:, i], 0, 0)
            add(Q[2:, i + 1] - Q[2:, i] - h / 2 * (U[1:, i] + U[1:, i + 1]), 0, 0)
            way = ca.SX.zeros(2)
            for at, weight in zip(NODES, WEIGHTS, strict=True):
                heading = Q[2, i] + h * (U[1, i] * (at - at**2 / 2) + U[1, i + 1] * at**2 / 2)
                speed = U[0, i] * (1 - at) + U[0, i + 1] * at
                way += weight * h * speed * ca.vertcat(ca.cos(heading), ca.sin(heading))
            add(Q[:2, i + 1] - Q[:2, i] - way, 0, 0)
            for c in range(3, n):
                if np.isfinite(group.lower[c]):
                    add(Q[c, i] + h / 2 * U[c - 1, i], group.lower[c], group.upper[c])
        half = limits["wheel_separation"] / 2
        for i in range(N):
            for side in (-half, half):
                add(U[0, i] + side * U[1, i], -limits["wheel_velocity"], limits["wheel_velocity"])
        _, p = self.fk(Q[:, intervals[0]])
        add(G[:3, :3].T @ (p - G[:3, 3]), 0, 0)
        add(self.turned(Q[:, intervals[0]], turn), 0, 0)
        x = ca.vertcat(ca.vec(Q), ca.vec(U), ca.vec(A), H)
        smoothing = 1e-2 / (N - 1) * ca.sumsqr(A / ca.repmat(ca.DM(acceleration), 1, N - 1))
        f = sum(H[s] * count for s, count in enumerate(intervals)) + smoothing
        solver = ca.nlpsol(
            "solver", "ipopt", {"x": x, "f": f, "g": ca.vertcat(*g), "p": ca.vertcat(ca.vec(G), turn)},
            {"print_time": False, "ipopt": IPOPT},
        )  # fmt: skip
        self.solvers[intervals] = (solver, np.array(low), np.array(high), velocity, acceleration)
        return self.solvers[intervals]

    def prepare(self, intervals) -> None:
        self._solver(tuple(intervals))

    def solve(self, guess: dict, pose: np.ndarray) -> tuple[bool, float]:
        intervals = tuple(guess["intervals"])
        solver, low, high, velocity, acceleration = self._solver(intervals)
        Q = np.asarray(guess["positions"]).T
        n, N = Q.shape
        h = np.repeat(guess["steps"], intervals)
        rate = np.zeros((n, N))
        rate[:, 1:-1] = (Q[:, 2:] - Q[:, :-2]) / (h[1:] + h[:-1])
        U = rate[1:].copy()
        U[0] = rate[0] * np.cos(Q[2]) + rate[1] * np.sin(Q[2])
        U = np.clip(U, -velocity[:, None], velocity[:, None])
        A = np.clip(np.diff(U) / h, -acceleration[:, None], acceleration[:, None])
        lower_q = np.where(np.isfinite(self.group.lower), self.group.lower, -np.inf)
        upper_q = np.where(np.isfinite(self.group.upper), self.group.upper, np.inf)
        lower_q[2], upper_q[2] = -np.inf, np.inf
        low_q, high_q = np.repeat(lower_q[:, None], N, 1), np.repeat(upper_q[:, None], N, 1)
        low_q[:, 0] = high_q[:, 0] = Q[:, 0]
        low_q[:, -1] = high_q[:, -1] = np.asarray(guess["goal"])
        high_u = np.repeat(velocity[:, None], N, 1)
        high_u[:, 0] = high_u[:, -1] = 0
        high_a = np.repeat(acceleration[:, None], N - 1, 1)
        flat = [m.flatten("F") for m in (Q, U, A)]
        bounds = [np.concatenate([low_q.flatten("F"), -high_u.flatten("F"), -high_a.flatten("F"), [1e-4] * len(intervals)]),
                  np.concatenate([high_q.flatten("F"), high_u.flatten("F"), high_a.flatten("F"), [100.0] * len(intervals)])]  # fmt: skip
        *xyz, w = mg.robot.quat_xyzw_from_rotation(np.asarray(pose)[:3, :3])
        found = solver(
            x0=np.concatenate([*flat, guess["steps"]]), lbx=bounds[0], ubx=bounds[1], lbg=low, ubg=high,
            p=np.concatenate([np.asarray(pose).flatten("F"), [w, *xyz]]),
        )  # fmt: skip
        x = np.asarray(found["x"]).ravel()
        steps = x[-len(intervals) :]
        at = x[: n * N].reshape(N, n)[intervals[0]]
        reached = bool(np.allclose(self.group.fk(at), pose, atol=1e-5))
        return solver.stats()["success"] and reached, float(steps @ np.array(intervals))
