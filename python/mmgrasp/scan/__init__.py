"""From a folder of depth frames to a map: `mmgrasp scan` as Python calls."""

from .integration import FrameRecord as FrameRecord
from .integration import Scan as Scan
from .integration import ScanOptions as ScanOptions
from .integration import SkippedFrame as SkippedFrame
from .integration import choose_options as choose_options
from .integration import integrate_frames as integrate_frames
from .integration import occupancy_of as occupancy_of
from .objects import Segmentation as Segmentation
from .objects import SegmentedObject as SegmentedObject
from .objects import mean_up as mean_up
from .objects import objects_on_plane as objects_on_plane
from .ply import write_ply as write_ply
from .progress_file import read_scan as read_scan
from .progress_file import scan_to_dict as scan_to_dict
