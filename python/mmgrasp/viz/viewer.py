"""The plan in the browser: robot, scene, regions, stops, and the motion to play (viser, an optional extra)."""

from __future__ import annotations

import time
from typing import Any

import numpy as np

from .._core import quat_xyzw_from_rotation
from ..part_supply.drives import all_drives
from .pictures import write_scene as write_png
from .scene import PlanScene, obstacle_colour
from .style import PART, STOP, rgb, tray_colour

__all__ = ["PlanViewer", "view", "write_png"]


def _wxyz(T: np.ndarray) -> np.ndarray:
    """Quaternion (w, x, y, z) of T's rotation."""
    x, y, z, w = quat_xyzw_from_rotation(T[:3, :3])
    return np.array([w, x, y, z])


class PlanViewer:
    """A viser server that shows one plan. `show(time)` moves everything; play, pause and a slider do so in the browser."""

    def __init__(self, plan: dict[str, Any], host: str = "127.0.0.1", port: int = 8080):
        try:
            import viser
        except ImportError as error:
            raise ImportError("the viewer needs viser: pip install 'mmgrasp[view]'") from error
        self.plan = plan
        self.scene = PlanScene(plan)
        self.server = viser.ViserServer(host=host, port=port, verbose=False)
        self.server.scene.set_up_direction("+z")
        self.links: dict[str, Any] = {}
        self.parts: dict[str, Any] = {}
        self._add_scene()
        self._add_regions()
        self._add_controls()
        self.show(0.0)

    def _mesh(self, name: str, V: np.ndarray, F: np.ndarray, colour: str, T: np.ndarray | None = None) -> Any:
        T = np.eye(4) if T is None else T
        return self.server.scene.add_mesh_simple(
            name, V, F, color=rgb(colour), flat_shading=True, position=T[:3, 3], wxyz=_wxyz(T)
        )

    def _add_scene(self) -> None:
        bodies = self.scene.bodies
        self.server.scene.add_grid(
            "/floor", width=20, height=20, cell_size=0.5, section_size=1.0, position=(0, 0, bodies.floor)
        )
        for body in bodies.obstacles:
            self._mesh(f"/scene/{body.name}", body.vertices, body.faces, obstacle_colour(body.name), body.pose)
        for part in bodies.parts.values():
            self.parts[part.name] = self._mesh(f"/parts/{part.name}", part.vertices, part.faces, PART, part.pose)
        for link in bodies.links:
            if link.shapes:
                colour = self.scene.link_colour(link.name)
                self.links[link.name] = self._mesh(f"/robot/{link.name}", link.vertices, link.faces, colour)

    def _add_regions(self) -> None:
        grid = self.plan["grid"]
        h = grid["resolution"]
        names = [tray["name"] for tray in self.plan["scenario"]["trays"]]
        for region in self.plan["regions"]:
            corners: list[tuple[float, float, float]] = []
            faces: list[tuple[int, int, int]] = []
            height = 0.003 + 0.002 * names.index(region["tray"])
            for runs in region["cells"].values():
                for iy, start, end in runs:
                    x0, x1 = grid["origin"][0] + start * h, grid["origin"][0] + end * h
                    y0, y1 = grid["origin"][1] + iy * h, grid["origin"][1] + (iy + 1) * h
                    k = len(corners)
                    corners += [(x0, y0, height), (x1, y0, height), (x1, y1, height), (x0, y1, height)]
                    faces += [(k, k + 1, k + 2), (k, k + 2, k + 3)]
            if faces:
                self.server.scene.add_mesh_simple(
                    f"/regions/{region['tray']}", np.array(corners), np.array(faces),
                    color=rgb(tray_colour(names.index(region["tray"]))), opacity=0.45,
                )  # fmt: skip
        for number, stop in enumerate(self.plan["stops"], start=1):
            angles = np.linspace(0, 2 * np.pi, 49)
            ring = np.c_[
                stop["pose"][0] + stop["radius"] * np.cos(angles),
                stop["pose"][1] + stop["radius"] * np.sin(angles),
                np.full(49, 0.03),
            ]
            self.server.scene.add_spline_catmull_rom(f"/stops/{number}", ring, color=rgb(STOP), line_width=4)
            self.server.scene.add_label(f"/stops/{number}/label", f"stop {number}", position=(*stop["pose"][:2], 0.1))
        for index, leg in enumerate(all_drives(self.plan)):
            points = np.asarray(leg["poses"], float).reshape(-1, 3).copy()
            points[:, 2] = 0.02
            if len(points) > 1:
                segments = np.stack([points[:-1], points[1:]], axis=1)
                self.server.scene.add_line_segments(f"/route/{index}", segments, colors=(40, 40, 40), line_width=3)

    def _add_controls(self) -> None:
        gui = self.server.gui
        self.play = gui.add_button("Play")
        self.speed = gui.add_slider("speed", min=0.25, max=8.0, step=0.25, initial_value=1.0)
        duration = max(self.scene.timeline.duration, 0.01)
        self.slider = gui.add_slider("time [s]", min=0.0, max=duration, step=0.01, initial_value=0.0)
        self.label = gui.add_text("now", initial_value="", disabled=True)
        self.playing = False

        def turn(_event: Any) -> None:
            self.playing = not self.playing
            self.play.name = "Pause" if self.playing else "Play"

        self.play.on_click(turn)
        self.slider.on_update(lambda _event: self.show(float(self.slider.value)))

    def show(self, when: float) -> None:
        """Moves everything to where it is at this time [s]."""
        state = self.scene.timeline.state_at(when)
        poses = self.scene.robot_poses(state)
        for name, handle in self.links.items():
            handle.position, handle.wxyz = poses[name][:3, 3], _wxyz(poses[name])
        for name, handle in self.parts.items():
            T = self.scene.part_pose(name, state, poses)
            handle.visible = T is not None
            if T is not None:
                handle.position, handle.wxyz = T[:3, 3], _wxyz(T)
        self.label.value = self.scene.timeline.segment_at(when).label

    def run(self) -> None:
        """Serves until interrupted; advances the clock while playing."""
        last = time.monotonic()
        while True:
            time.sleep(1 / 30)
            now = time.monotonic()
            if self.playing:
                when = float(self.slider.value) + (now - last) * float(self.speed.value)
                self.slider.value = 0.0 if when >= self.scene.timeline.duration else when
            last = now


def view(plan: dict[str, Any], port: int = 8080, open_browser: bool = True, block: bool = True) -> PlanViewer:
    """Opens the plan in the browser. With `block`, serves until Ctrl-C."""
    viewer = PlanViewer(plan, port=port)
    address = f"http://127.0.0.1:{viewer.server.get_port()}"
    print(f"showing the plan at {address} (Ctrl-C ends)")
    if open_browser:
        import webbrowser

        webbrowser.open(address)
    if block:
        try:
            viewer.run()
        except KeyboardInterrupt as ended:
            viewer.server.stop()
            if type(ended) is not KeyboardInterrupt:  # by a signal that is no Ctrl-C
                raise
    return viewer
