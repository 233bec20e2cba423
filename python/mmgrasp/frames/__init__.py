"""Depth images with poses from the folders that people have: TUM RGB-D, Redwood and Open3D, 7-Scenes, and our own `.npz`.

`open_frames(folder)` recognises the layout and lists the frames; `FrameFolder.read` gives one as a DepthImage in metres with
T_world_camera. See docs/frames_format.md.
"""

from .folder import FrameFolder as FrameFolder
from .folder import LoadedFrame as LoadedFrame
from .folder import open_frames as open_frames
from .frame import Frame as Frame
from .npz import write_npz_frame as write_npz_frame
from .sensors import Sensor as Sensor
from .sensors import read_sensors as read_sensors
