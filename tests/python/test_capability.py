"""mg.base.CapabilityMap: arrays, their meaning, and pictures."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from matplotlib.backends.backend_agg import FigureCanvasAgg

import mmgrasp as mg
from mmgrasp._files import shipped
from mmgrasp.viz.capability import grid_of, map_figure, map_values

OPTIONS: dict[str, Any] = {"voxel": 0.2, "poses": 10, "approach": (1.0, 0.0, 0.0)}


@pytest.fixture(scope="module")
def robot() -> mg.Robot:
    return mg.Robot.load(
        shipped("asset:robots/fetchlike/fetchlike.urdf"), shipped("asset:robots/fetchlike/fetchlike.srdf")
    )


@pytest.fixture(scope="module")
def arm(robot: mg.Robot) -> mg.robot.JointGroup:
    return robot.group("arm").with_reference({"torso_lift_joint": 0.2})


@pytest.fixture(scope="module")
def made(arm: mg.robot.JointGroup) -> mg.base.CapabilityMap:
    return mg.base.CapabilityMap.build(arm, **OPTIONS)


def test_arrays_agree(made: mg.base.CapabilityMap, arm: mg.robot.JointGroup) -> None:
    assert made.shape == (10, 10, 13)
    assert made.index.shape == made.shape and made.index.dtype == np.float32
    assert made.classes.shape == (*made.shape, 10) and made.classes.dtype == np.uint8
    np.testing.assert_allclose((made.classes == 0).mean(axis=-1), made.index, atol=1e-6)
    assert made.configurations.shape == (made.reached, len(arm.names))
    assert made.maximum == pytest.approx(made.index.max())
    assert made.reached + sum(
        getattr(made.rejections, c) for c in ("unreachable", "limits", "self_collision", "scene")
    ) == (made.classes.size)
    with pytest.raises(ValueError):
        made.index[0, 0, 0] = 1


def test_rows_of_configurations_follow_the_classes(made: mg.base.CapabilityMap, arm: mg.robot.JointGroup) -> None:
    places = np.argwhere(made.classes == 0)
    for row in (0, len(places) // 2, len(places) - 1):
        x, y, z, k = (int(v) for v in places[row])
        T = made.tool_poses[k].copy()
        T[:3, 3] += made.centres[x, y, z]
        np.testing.assert_allclose(arm.fk(made.configurations[row].astype(float)), T, atol=1.5e-4)
        np.testing.assert_array_equal(made.configuration(x, y, z, k), made.configurations[row])
    x, y, z, k = (int(v) for v in np.argwhere(made.classes != 0)[0])
    assert made.configuration(x, y, z, k) is None


def test_slices_and_points(made: mg.base.CapabilityMap) -> None:
    np.testing.assert_array_equal(made.slice("z", 0.75), made.index[:, :, 3])
    np.testing.assert_array_equal(made.slice("y", 0.0), made.index[:, 5, :])
    assert made.index_at(made.centres[7, 4, 4]) == pytest.approx(float(made.index[7, 4, 4]))
    with pytest.raises(mg.InvalidInput, match="axis"):
        made.slice("w", 0)
    with pytest.raises(mg.InvalidInput, match="at"):
        made.slice("z", 3.0)


def test_a_table_takes_away_what_it_covers(made: mg.base.CapabilityMap, arm: mg.robot.JointGroup) -> None:
    world = mg.World()
    world.add_box("table", size=(0.8, 1.6, 0.05), pose=mg.pose([0.9, 0, 0.7]))
    with_table = mg.base.CapabilityMap.build(arm, world, **OPTIONS)
    restricted = made.restricted(arm, world)
    assert with_table.rejections.scene > 0
    assert not ((restricted.classes == 0) & (made.classes != 0)).any()
    assert ((restricted.classes == 0) != (with_table.classes == 0)).mean() < 0.005
    assert with_table.reached < made.reached


def test_the_best_distance_is_the_best_of_the_scores(made: mg.base.CapabilityMap) -> None:
    targets = np.stack([mg.pose([2.0, y, 0.85]) for y in (-0.1, 0.1)])
    distances = [0.3, 0.5, 0.7, 0.9, 1.5]
    distance, score, scores = made.best_base_distance(targets, distances)
    assert score == max(scores) and distance == distances[int(np.argmax(scores))]
    for d, s in zip(distances, scores, strict=True):
        expected = np.mean([made.index_at([d, y, 0.85]) for y in (-0.1, 0.1)])
        assert s == pytest.approx(expected)
    with pytest.raises(mg.InvalidInput, match="distances"):
        made.best_base_distance(targets, [])


def test_unknown_options_are_named(arm: mg.robot.JointGroup) -> None:
    with pytest.raises(mg.InvalidInput, match="voxel"):
        mg.base.CapabilityMap.build(arm, voxels=0.1)  # type: ignore[call-arg]


def test_pictures_show_the_map(made: mg.base.CapabilityMap, robot: mg.Robot) -> None:
    values = map_values(made, robot, {"torso_lift_joint": 0.2}, [])
    np.testing.assert_allclose(grid_of(values), made.index, atol=6e-4)
    figure = map_figure(values)
    assert len(figure.axes) == 4  # two cuts, the view, the scale
    canvas: Any = FigureCanvasAgg(figure)
    canvas.draw()
    picture = np.asarray(canvas.buffer_rgba())
    assert picture.std() > 10


def test_numpy_reads_what_save_writes(made: mg.base.CapabilityMap, tmp_path: Path) -> None:
    made.save(tmp_path / "map")
    for name in ("index", "classes", "configurations"):
        np.testing.assert_array_equal(np.load(tmp_path / "map" / f"{name}.npy"), getattr(made, name))
    # Tool poses are computed when asked for: another order of sums rounds otherwise.
    np.testing.assert_allclose(np.load(tmp_path / "map" / "tool_poses.npy"), made.tool_poses, rtol=0, atol=1e-15)
    again = mg.base.CapabilityMap.load(tmp_path / "map")
    np.testing.assert_array_equal(again.classes, made.classes)
    with pytest.raises(mg.IoError, match="nowhere"):
        mg.base.CapabilityMap.load(tmp_path / "nowhere")
