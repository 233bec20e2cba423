#pragma once

#include "mmgrasp/structure/beam_frame.hpp"

namespace mmgrasp {

/// P2 figure 3.4 by its matrix: six sections, seven nodes, a branch at the fourth (indices here from 0).
inline Pipe figure_3_4() {
  Pipe pipe;
  pipe.nodes = {{0, 0, 0},        {0.2, 0, 0},      {0.2, 0.2, 0},   {0.2, 0.2, 0.15},
                {0.4, 0.2, 0.15}, {0.2, 0.6, 0.15}, {0.2, 0.6, 0.25}};
  pipe.sections = {{0, 1}, {1, 2}, {2, 3}, {3, 4}, {3, 5}, {5, 6}};
  pipe.diameters.assign(6, 0.012);
  return pipe;
}

/// Pipe1 of P2 (tables 3.3 and 3.4).
inline BeamFrame figure_3_4_frame() {
  return beam_frame(figure_3_4(), 0.010, copper());
}

/// A rectangle, askew, with legs and a stay, of several sections, one of them turned.
inline BeamFrame closed_frame() {
  BeamFrame frame;
  frame.nodes = {{0, 0, 0},      {0.4, 0.1, 0.05},  {0.35, 0.5, 0.1}, {-0.1, 0.4, 0},
                 {0, 0.05, 0.3}, {0.45, 0.1, 0.35}, {0.4, 0.5, -0.3}, {-0.1, 0.45, -0.2}};
  const int ends[8][2] = {{0, 1}, {1, 2}, {2, 3}, {3, 0}, {0, 4}, {1, 5}, {2, 6}, {3, 7}};
  const BeamSection sections[3] = {round_section(0.02, 0.016), rectangular_section(0.02, 0.03, 0.002),
                                   rectangular_section(0.01, 0.02)};
  for (int i = 0; i < 8; ++i) {
    BeamMember member;
    member.nodes = {ends[i][0], ends[i][1]};
    member.section = sections[i % 3];
    member.material = i % 2 ? copper() : BeamMaterial{2700, 70e9, 26e9, 1e8};
    if (i == 2) member.y_towards = Eigen::Vector3d(1, 2, 3);
    frame.members.push_back(member);
  }
  return frame;
}

}  // namespace mmgrasp
