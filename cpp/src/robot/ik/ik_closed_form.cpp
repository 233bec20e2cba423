#include "mmgrasp/robot/detail/ik_closed_form.hpp"

#include <algorithm>
#include <optional>

#include "robot/ik/ik_subproblems.hpp"

namespace mmgrasp::detail {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

// How far axes may be from meeting or from parallel: URDFs print angles with five digits or more. The answer is
// polished on the true chain, so a loose bound costs nothing but steps.
constexpr double kMeet = 1e-4;      // [m]
constexpr double kParallel = 1e-4;  // sine of the angle

bool parallel(const Screws& s, int i, int j) {
  return s.h[i].cross(s.h[j]).norm() < kParallel;
}

/// Where the axes i and j meet (the middle of their common normal).
std::optional<Vector3d> meeting_point(const Screws& s, int i, int j) {
  const Vector3d between = s.p[j] - s.p[i], normal = s.h[i].cross(s.h[j]);
  const double sine2 = normal.squaredNorm();
  if (sine2 < kParallel * kParallel) return std::nullopt;
  if (std::abs(between.dot(normal)) > kMeet * std::sqrt(sine2)) return std::nullopt;
  const Vector3d on_i = s.p[i] + between.cross(s.h[j]).dot(normal) / sine2 * s.h[i];
  const Vector3d on_j = s.p[j] + between.cross(s.h[i]).dot(normal) / sine2 * s.h[j];
  return Vector3d(0.5 * (on_i + on_j));
}

std::optional<Vector3d> wrist_point(const Screws& s) {
  const std::optional<Vector3d> point = meeting_point(s, 3, 4);
  if (!point || parallel(s, 4, 5)) return std::nullopt;
  return (*point - s.p[5]).cross(s.h[5]).norm() < kMeet ? point : std::nullopt;
}

Screws reversed(const Screws& s) {
  Screws r;
  r.size = s.size;
  for (int i = 0; i < s.size; ++i) {
    r.h[i] = s.h[s.size - 1 - i];
    r.p[i] = s.p[s.size - 1 - i];
  }
  return r;
}

/// Joint values 1-3 that bring the wrist point w to t, at most four times.
struct Positions {
  std::array<std::array<double, 3>, 4> value;
  int count = 0;
  bool free = false;
  void add(double a, double b, double c) {
    if (count < 4) value[count++] = {a, b, c};
  }
};

/// The same angles; `free` is set when they stand for any.
AngleSolutions noted(const AngleSolutions& angles, bool& free) {
  free = free || angles.free;
  return angles;
}

/// E_i E_j u = v for axes that meet in o: the first turn must keep h_i . u.
template <class Use>
void two_turns(const Vector3d& hi, const Vector3d& hj, const Vector3d& o, const Vector3d& u, const Vector3d& v,
               bool& free, const Use& use) {
  for (const double second : noted(angles_to_plane(hj, hi, u - o, hi.dot(v - o)), free))
    use(angle_onto(hi, turned(hj, second, u - o), v - o, free), second);
}

Vector3d turned_point(const Screws& s, int i, double angle, const Vector3d& x) {
  return s.p[i] + turned(s.h[i], angle, x - s.p[i]);
}

Positions wrist_positions(const Screws& s, const Vector3d& w, const Vector3d& t) {
  Positions found;
  if (const auto o = meeting_point(s, 0, 1)) {  // both keep the distance from o
    for (const double third : noted(angles_to_distance(s.h[2], w - s.p[2], *o - s.p[2], (t - *o).norm()), found.free))
      two_turns(s.h[0], s.h[1], *o, turned_point(s, 2, third, w), t, found.free,
                [&](double first, double second) { found.add(first, second, third); });
  } else if (const auto o = meeting_point(s, 1, 2)) {
    for (const double first : noted(angles_to_distance(s.h[0], t - s.p[0], *o - s.p[0], (w - *o).norm()), found.free))
      two_turns(s.h[1], s.h[2], *o, w, turned_point(s, 0, first, t), found.free,
                [&](double second, double third) { found.add(-first, second, third); });
  } else if (parallel(s, 1, 2)) {  // both keep the height along their axes
    for (const double first : noted(angles_to_plane(s.h[0], s.h[1], t - s.p[0], s.h[1].dot(w - s.p[0])), found.free)) {
      const Vector3d u = turned_point(s, 0, first, t);
      for (const double third :
           noted(angles_to_distance(s.h[2], w - s.p[2], s.p[1] - s.p[2], (u - s.p[1]).norm()), found.free))
        found.add(-first, angle_onto(s.h[1], turned_point(s, 2, third, w) - s.p[1], u - s.p[1], found.free), third);
    }
  } else if (parallel(s, 0, 1)) {
    for (const double third : noted(angles_to_plane(s.h[2], s.h[0], w - s.p[2], s.h[0].dot(t - s.p[2])), found.free)) {
      const Vector3d u = turned_point(s, 2, third, w);
      for (const double second :
           noted(angles_to_distance(s.h[1], u - s.p[1], s.p[0] - s.p[1], (t - s.p[0]).norm()), found.free))
        found.add(angle_onto(s.h[0], turned_point(s, 1, second, u) - s.p[0], t - s.p[0], found.free), second, third);
    }
  }
  return found;
}

Vector3d across(const Vector3d& h) {
  Eigen::Index smallest;
  h.cwiseAbs().minCoeff(&smallest);
  return h.cross(Vector3d::Unit(smallest)).normalized();
}

void add(Branches& branches, const std::array<double, 6>& values, bool reversed) {
  if (branches.count == Branches::kMaxBranches) return;
  auto& slot = branches.value[branches.count++];
  for (std::size_t i = 0; i < 6; ++i) slot[i] = reversed ? -values[5 - i] : values[i];
}

void solve_spherical(const Screws& s, const Rigid& G, bool reversed, Branches& branches) {
  const Vector3d w = *wrist_point(s);
  const Positions positions = wrist_positions(s, w, G * w);
  branches.free = branches.free || positions.free;
  const Vector3d y = across(s.h[5]);
  for (int i = 0; i < positions.count; ++i) {
    const auto& found = positions.value[i];
    const double a = found[0], b = found[1], c = found[2];
    const Turn one(s.h[0], a), two(s.h[1], b), three(s.h[2], c);
    const auto back = [&](const Vector3d& x) { return three.back(two.back(one.back(x))); };
    const Vector3d Rh = back(G.R * s.h[5]), Ry = back(G.R * y);
    for (const double fifth : noted(angles_to_plane(s.h[4], s.h[3], s.h[5], s.h[3].dot(Rh)), branches.free)) {
      const Turn five(s.h[4], fifth);
      const double fourth = angle_onto(s.h[3], five(s.h[5]), Rh, branches.free);
      const double sixth = angle_onto(s.h[5], y, five.back(turned(s.h[3], -fourth, Ry)), branches.free);
      add(branches, {a, b, c, fourth, fifth, sixth}, reversed);
    }
  }
}

void solve_parallel(const Screws& s, const Rigid& G, bool reversed, Branches& branches) {
  const Vector3d h = s.h[1];
  const Vector3d o = *meeting_point(s, 4, 5);
  const Vector3d Go = G * o, Gh = G.R * s.h[5];
  const Vector3d y = across(h);
  for (const double first : noted(angles_to_plane(s.h[0], h, Go - s.p[0], h.dot(o - s.p[0])), branches.free)) {
    const Turn one(s.h[0], first);
    const Vector3d u = s.p[0] + one(Go - s.p[0]), uh = one(Gh);
    const Vector3d right = G.R.transpose() * one.back(h);
    for (const double fifth : noted(angles_to_plane(s.h[4], h, s.h[5], h.dot(uh)), branches.free)) {
      // R_6^T R_5^T h = G^T R_1 h
      const Turn five(s.h[4], fifth);
      const double sixth = -angle_onto(s.h[5], five.back(h), right, branches.free);
      // What joints 2-4 turn together, and where they bring the point o.
      const Vector3d Ry = one(G.R * turned(s.h[5], -sixth, five.back(y)));
      const double sum = angle_onto(h, y, Ry, branches.free);
      const Vector3d p4 = u + turned(h, sum, s.p[3] - o);
      for (const double third :
           noted(angles_to_distance(s.h[2], s.p[3] - s.p[2], s.p[1] - s.p[2], (p4 - s.p[1]).norm()), branches.free)) {
        const double second = angle_onto(h, turned_point(s, 2, third, s.p[3]) - s.p[1], p4 - s.p[1], branches.free);
        const double sign3 = s.h[2].dot(h) > 0 ? 1 : -1, sign4 = s.h[3].dot(h) > 0 ? 1 : -1;
        add(branches, {-first, second, third, sign4 * (sum - second - sign3 * third), fifth, sixth}, reversed);
      }
    }
  }
}

ClosedForm::Family family_of(const Screws& s) {
  if (wrist_point(s) && (meeting_point(s, 0, 1) || meeting_point(s, 1, 2) || parallel(s, 1, 2) || parallel(s, 0, 1)))
    return ClosedForm::Family::spherical;
  if (parallel(s, 1, 2) && parallel(s, 1, 3) && meeting_point(s, 4, 5)) return ClosedForm::Family::parallel;
  return ClosedForm::Family::none;
}

}  // namespace

Rigid turn_about(const Vector3d& h, const Vector3d& p, double angle) {
  Rigid motion;
  motion.R = Eigen::AngleAxisd(angle, h).toRotationMatrix();
  motion.t = p - motion.R * p;
  return motion;
}

bool one_joint_a_column(const JointGroup& group) {
  const Robot& robot = group.robot();
  const auto in_group = [&](const Joint& joint) {
    return std::find(group.names().begin(), group.names().end(), joint.name) != group.names().end();
  };
  for (int link = group.tip_link(); link > 0;) {
    const Joint& joint = robot.joints()[robot.links()[link].parent_joint];
    if (joint.type == JointType::planar || joint.type == JointType::floating) return false;
    if (joint.mimic_joint >= 0 && in_group(robot.joints()[joint.mimic_joint])) return false;
    link = joint.parent_link;
  }
  return true;
}

Screws screws_of(const JointGroup& group) {
  Screws screws;
  const int n = group.size();
  if (group.has_base() || (n != 6 && n != 7) || !one_joint_a_column(group)) return screws;
  // A column of the Jacobian is the joint's screw: turning about w, the tip moves by w x (p_tip - p).
  Pose T_world_tip;
  Matrix6Xd J(6, n);
  group.fk_jacobian(Eigen::VectorXd::Zero(n), T_world_tip, J);
  for (int i = 0; i < n; ++i) {
    const Vector3d v = J.col(i).head<3>(), w = J.col(i).tail<3>();
    if (std::abs(w.norm() - 1) > 1e-9) return screws;  // slides, or is not on the way to the tip
    screws.h[i] = w;
    screws.p[i] = T_world_tip.translation() - v.cross(w);
  }
  screws.tip = Rigid(T_world_tip);
  screws.size = n;
  return screws;
}

ClosedForm closed_form_of(const Screws& six) {
  const ClosedForm::Family forward = family_of(six);
  if (forward != ClosedForm::Family::none) return {forward, false};
  return {family_of(reversed(six)), true};
}

void solve_closed_form(const ClosedForm& form, const Screws& six, const Rigid& G, Branches& branches) {
  branches.count = 0;
  branches.free = false;
  if (form.family == ClosedForm::Family::none) return;
  const Screws s = form.reversed ? reversed(six) : six;
  const Rigid target = form.reversed ? G.inverse() : G;
  if (form.family == ClosedForm::Family::spherical)
    solve_spherical(s, target, form.reversed, branches);
  else
    solve_parallel(s, target, form.reversed, branches);
}

int redundant_joint(const Screws& seven) {
  if (seven.size != 7) return -1;
  for (const int locked : {6, 0, 2, 1, 3, 4, 5}) {
    Rigid G;
    bool always = true;
    for (const double angle : {0.3, 1.7, -2.1})  // no special angles: what holds here holds everywhere
      always = always && closed_form_of(lock_joint(seven, locked, angle, G)).family != ClosedForm::Family::none;
    if (always) return locked;
  }
  return -1;
}

Screws lock_joint(const Screws& seven, int locked, double angle, Rigid& G) {
  // E_k moves to the other side of the joints behind it: E_k E_j = (E_k E_j E_k^-1) E_k.
  const Rigid E = turn_about(seven.h[locked], seven.p[locked], angle);
  Screws six;
  six.size = 6;
  for (int i = 0; i < 6; ++i) {
    const std::size_t from = i < locked ? i : i + 1;
    six.h[i] = i < locked ? seven.h[from] : Vector3d(E.R * seven.h[from]);
    six.p[i] = i < locked ? seven.p[from] : E * seven.p[from];
  }
  G = G * E.inverse();
  return six;
}

}  // namespace mmgrasp::detail
