#include "structure/bound/ik_enclosure.hpp"

#include <algorithm>
#include <optional>
#include <string>

#include "mmgrasp/core/error.hpp"
#include "mmgrasp/robot/detail/ik_closed_form.hpp"

namespace mmgrasp::detail {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double kSpecial = 1e-6;   // [m] and sine of the angle
constexpr double kPolished = 2e-9;  // [m] and [rad]: how far a polished configuration may be from its pose

bool are_parallel(const Screws& s, int i, int j) {
  return s.h[i].cross(s.h[j]).norm() < kSpecial;
}

/// Where two axes meet.
std::optional<Vector3d> meeting_point(const Screws& s, int i, int j) {
  const Vector3d between = s.p[j] - s.p[i], normal = s.h[i].cross(s.h[j]);
  const double sine2 = normal.squaredNorm();
  if (sine2 < 1e-4 || std::abs(between.dot(normal)) > kSpecial * std::sqrt(sine2)) return std::nullopt;
  const Vector3d on_i = s.p[i] + between.cross(s.h[j]).dot(normal) / sine2 * s.h[i];
  const Vector3d on_j = s.p[j] + between.cross(s.h[i]).dot(normal) / sine2 * s.h[j];
  return Vector3d((on_i + on_j) / 2);
}

double distance_to_axis(const Screws& s, int i, const Vector3d& x) {
  return (x - s.p[i]).cross(s.h[i]).norm();
}

/// Which of the two kinds an arm is.
struct Geometry {
  Vector3d meeting;  ///< Where axes 5 and 6 meet.
  bool spherical = false;
};

/// Longer than the tip and the wrist are from any axis in any configuration: consecutive points are on one link.
double longest_lever(const Screws& s, const Vector3d& wrist) {
  double sum = std::max((s.tip.t - s.p[5]).norm(), (wrist - s.p[5]).norm());
  for (int i = 0; i < 5; ++i) sum += (s.p[i + 1] - s.p[i]).norm();
  return sum;
}

std::optional<Geometry> geometry_of(const Screws& s) {
  const auto wrist = s.size == 6 ? meeting_point(s, 4, 5) : std::nullopt;
  if (!wrist || !are_parallel(s, 1, 2) || are_parallel(s, 0, 1)) return std::nullopt;
  const bool spherical = !are_parallel(s, 3, 4) && distance_to_axis(s, 3, *wrist) < kSpecial;
  if (!spherical && !are_parallel(s, 1, 3)) return std::nullopt;
  return Geometry{*wrist, spherical};
}

Vector3d across(const Vector3d& h) {
  Eigen::Index smallest;
  h.cwiseAbs().minCoeff(&smallest);
  return h.cross(Vector3d::Unit(smallest)).normalized();
}

}  // namespace

bool IkEnclosure::takes(const JointGroup& group) {
  return geometry_of(screws_of(group)).has_value();
}

IkEnclosure::IkEnclosure(const JointGroup& group) : group_(group) {
  const Screws s = screws_of(group);
  const auto geometry = geometry_of(s);
  require(geometry.has_value(), "group", group.name(),
          "must be an arm of six turning joints without a base, whose axes 2 and 3 are parallel and either 4, 5 and 6 "
          "meet in a point or 4 is parallel, too, and 5 and 6 meet, all within 1e-6 m and rad: only for these bounds "
          "are proven (a population search takes any arm)");
  for (int i = 0; i < 6; ++i) {
    h_[i] = s.h[i].normalized();
    p_[i] = s.p[i];
  }
  meeting_ = geometry->meeting;
  spherical_ = geometry->spherical;
  // A turn about an axis that is off by dh in direction and dp in place differs by at most 5 dh in rotation and moves
  // points by 5 dh times their distance and 2 dp.
  off_rotation_ = off_position_ = kPolished;
  const double lever = longest_lever(s, meeting_);
  const auto snap = [&](int i, const Vector3d& h, const Vector3d& p) {
    const double dh = (h - h_[i]).norm(), dp = (p - p_[i]).cross(h_[i]).norm();
    off_rotation_ += 5 * dh;
    off_position_ += 5 * dh * lever + 2 * dp;
    h_[i] = h;
    p_[i] = p;
  };
  snap(2, h_[1] * (h_[1].dot(h_[2]) > 0 ? 1 : -1), p_[2]);
  if (!spherical_) snap(3, h_[1] * (h_[1].dot(h_[3]) > 0 ? 1 : -1), p_[3]);
  for (int i = spherical_ ? 3 : 4; i < 6; ++i) snap(i, h_[i], meeting_);
  if (spherical_ && h_[3].cross(h_[5]).norm() < 1e-9 && std::abs(h_[3].dot(h_[4])) < 1e-9) {
    wrist_sign_ = h_[3].dot(h_[5]) > 0 ? 1 : -1;
    off_rotation_ += 1e-8;
    off_position_ += 1e-8;
  }
  R_tip_ = s.tip.R;
  t_tip_ = s.tip.t;
}

FormVector IkEnclosure::turned(int joint, const Turn& turn, bool back, const FormVector& v) const {
  return detail::turned(h_[joint], turn.c, back ? -turn.s : turn.s, v);
}

FormVector IkEnclosure::turned_point(int joint, const Turn& turn, bool back, const FormVector& x) const {
  return turned(joint, turn, back, x - form(p_[joint])) + form(p_[joint]);
}

/// Angles of a turn about `axis` with k . R u = d.
std::vector<LinearForm> IkEnclosure::to_plane(const Vector3d& axis, const Vector3d& k, const FormVector& u,
                                              const LinearForm& d) const {
  // a cos + b sin = c, where a and b are the parts of k across the axis, seen from u
  const double along = k.dot(axis);
  const LinearForm a = dot(Vector3d(k - along * axis), u), b = dot(Vector3d(k.cross(axis)), u);
  const LinearForm c = d - along * dot(axis, u);
  const LinearForm length2 = squared(a) + squared(b);
  if (length2.low() <= 1e-12) return {full_circle()};
  const LinearForm ratio = c * reciprocal(square_root(length2));
  if (ratio.low() > 1 || ratio.high() < -1) return {};
  const LinearForm middle = angle_of(b, a), half = arc_cosine(ratio);
  return {middle + half, middle - half};
}

/// The turn about `axis` that brings u above v.
LinearForm IkEnclosure::onto(const Vector3d& axis, const FormVector& u, const FormVector& v) const {
  const FormVector across_u = cross(axis, u);
  return angle_of(dot(across_u, v), dot(u, v) - dot(axis, u) * dot(axis, v));
}

FormVector IkEnclosure::carried_direction(const FormPose& T, const Vector3d& v) const {
  FormVector out = T.turned(R_tip_.transpose() * v);
  for (LinearForm& x : out) x.error += off_rotation_ * v.norm();
  return out;
}

FormVector IkEnclosure::carried_point(const FormPose& T, const Vector3d& x) const {
  const Vector3d arm = R_tip_.transpose() * (x - t_tip_);
  FormVector out = T.turned(arm) + T.origin;
  for (LinearForm& y : out) y.error += off_rotation_ * arm.norm() + off_position_;
  return out;
}

void IkEnclosure::spherical(const FormPose& T, std::vector<FormConfiguration>& out) const {
  const Vector3d w = meeting_, y = across(h_[5]);
  const FormVector t = carried_point(T, w), h_now = carried_direction(T, h_[5]), y_now = carried_direction(T, y);
  const Vector3d from = w - p_[2], to = p_[1] - p_[2];
  for (const LinearForm& first : to_plane(h_[0], h_[1], t - form(p_[0]), LinearForm(h_[1].dot(w - p_[0])))) {
    const Turn one(first);  // joint 1 turns by -first
    const FormVector u = turned_point(0, one, false, t);
    // |R_3 from - to| = |u - p_1|
    const LinearForm reach2 = squared_norm(u - form(p_[1]));
    const LinearForm product = 0.5 * (LinearForm(from.squaredNorm() + to.squaredNorm()) - reach2);
    for (const LinearForm& third : to_plane(h_[2], to, form(from), product)) {
      const Turn three(third);
      const LinearForm second = onto(h_[1], turned_point(2, three, false, form(w)) - form(p_[1]), u - form(p_[1]));
      const Turn two(second);
      const auto back = [&](const FormVector& x) {
        return turned(2, three, true, turned(1, two, true, turned(0, one, false, x)));
      };
      if (wrist_sign_ != 0) {
        euler_wrist(back(carried_direction(T, h_[4].cross(h_[3]))), back(carried_direction(T, h_[4])),
                    back(carried_direction(T, h_[3])), {-first, second, third, {}, {}, {}, {}}, out);
        continue;
      }
      const FormVector Rh = back(h_now), Ry = back(y_now);
      for (const LinearForm& fifth : to_plane(h_[4], h_[3], form(h_[5]), dot(h_[3], Rh))) {
        const Turn five(fifth);
        const LinearForm fourth = onto(h_[3], turned(4, five, false, form(h_[5])), Rh);
        const Turn four(fourth);
        const LinearForm sixth = onto(h_[5], form(y), turned(4, five, true, turned(3, four, true, Ry)));
        out.push_back({-first, second, third, fourth, fifth, sixth, {}});
      }
    }
  }
}

/// Angles of R = Rz(4) Ry(5) Rz(sign 6), whose columns are given, along z (axis 4), y (axis 5) and x = y x z. The
/// entries tell each angle without going through the others, so errors do not pile up where the wrist is nearly
/// stretched.
void IkEnclosure::euler_wrist(const FormVector& Rx, const FormVector& Ry, const FormVector& Rz,
                              const FormConfiguration& arm, std::vector<FormConfiguration>& out) const {
  const Vector3d z = h_[3], y = h_[4], x = y.cross(z);
  const LinearForm sum = angle_of(dot(y, Rx) - dot(x, Ry), dot(x, Rx) + dot(y, Ry));
  const LinearForm cosine5 = dot(z, Rz), across2 = squared(dot(x, Rz)) + squared(dot(y, Rz));
  if (cosine5.low() > 1 || cosine5.high() < -1) return;
  LinearForm bent = arc_cosine(cosine5);
  if (across2.high() > 0) {
    const LinearForm other = angle_of(square_root(across2), cosine5);
    if (other.radius() < bent.radius()) bent = other;
  }
  for (const double sign : {1.0, -1.0}) {  // of sin(5)
    FormConfiguration q = arm;
    q[3] = angle_of(sign * dot(y, Rz), sign * dot(x, Rz));
    q[4] = sign * bent;
    q[5] = wrist_sign_ * angle_of(sign * dot(z, Ry), -sign * dot(z, Rx));
    q[6] = sum;
    out.push_back(q);
  }
}

void IkEnclosure::parallel(const FormPose& T, std::vector<FormConfiguration>& out) const {
  const Vector3d h = h_[1], o = meeting_, y = across(h);
  const Vector3d side = across(h_[5]), other = h_[5].cross(side);
  const FormVector o_now = carried_point(T, o), h_now = carried_direction(T, h_[5]),
                   side_now = carried_direction(T, side), other_now = carried_direction(T, other);
  const double sign3 = h_[2].dot(h) > 0 ? 1 : -1, sign4 = h_[3].dot(h) > 0 ? 1 : -1;
  for (const LinearForm& first : to_plane(h_[0], h, o_now - form(p_[0]), LinearForm(h.dot(o - p_[0])))) {
    const Turn one(first);
    const FormVector u = turned_point(0, one, false, o_now), uh = turned(0, one, false, h_now);
    const FormVector h_first = turned(0, one, true, form(h));
    for (const LinearForm& fifth : to_plane(h_[4], h, form(h_[5]), dot(h, uh))) {
      const Turn five(fifth);
      // R_6^T R_5^T h = G^T R_1 h; coordinates of the right side along h_5, side and other
      const FormVector right = dot(h_now, h_first) * form(h_[5]) + dot(side_now, h_first) * form(side) +
                               dot(other_now, h_first) * form(other);
      const LinearForm sixth = -onto(h_[5], turned(4, five, true, form(h)), right);
      const Turn six(sixth);
      const FormVector inner = turned(5, six, true, turned(4, five, true, form(y)));
      const FormVector inner_now =
          dot(h_[5], inner) * h_now + dot(side, inner) * side_now + dot(other, inner) * other_now;
      const LinearForm sum = onto(h, form(y), turned(0, one, false, inner_now));
      const Turn all(sum);
      const FormVector p4 = u + turned(1, all, false, form(p_[3] - o));
      const LinearForm reach2 = squared_norm(p4 - form(p_[1]));
      const Vector3d from = p_[3] - p_[2], to = p_[1] - p_[2];
      // only distances across the axes count: all three axes are parallel
      const double along = h.dot(from - to);
      const LinearForm height = dot(h, p4 - form(p_[1]));
      const LinearForm product =
          0.5 * (LinearForm(from.squaredNorm() + to.squaredNorm() - along * along) - (reach2 - squared(height)));
      for (const LinearForm& third : to_plane(h_[2], to, form(from), product)) {
        const Turn three(third);
        const LinearForm second = onto(h, turned_point(2, three, false, form(p_[3])) - form(p_[1]), p4 - form(p_[1]));
        out.push_back({-first, second, third, sign4 * (sum - second - sign3 * third), fifth, sixth, {}});
      }
    }
  }
}

std::vector<FormConfiguration> IkEnclosure::branches(const FormPose& T) const {
  std::vector<FormConfiguration> out;
  if (spherical_) {
    spherical(T, out);
  } else {
    parallel(T, out);
  }
  return out;
}

std::vector<FormConfiguration> IkEnclosure::within_limits(const FormPose& T) const {
  constexpr double kSlack = 1e-8;
  std::vector<FormConfiguration> out;
  for (const FormConfiguration& q : branches(T)) {
    std::vector<FormConfiguration> turns{q};
    for (int j = 0; j < 6; ++j) {
      if (group_.wraps()[j]) continue;
      const double low = group_.lower()[j] - kSlack, high = group_.upper()[j] + kSlack;
      std::vector<FormConfiguration> next;
      for (const FormConfiguration& each : turns) {
        if (each[j].radius() >= kPi) {  // nothing is known of it
          next.push_back(each);
          next.back()[j] = LinearForm::between(low, high);
          continue;
        }
        const auto from = static_cast<int>(std::ceil((low - each[j].high()) / kTwoPi));
        const auto to = static_cast<int>(std::floor((high - each[j].low()) / kTwoPi));
        for (int k = from; k <= to; ++k) {
          next.push_back(each);
          next.back()[j] += LinearForm(k * kTwoPi);
        }
      }
      turns.swap(next);
    }
    out.insert(out.end(), turns.begin(), turns.end());
  }
  return out;
}

std::array<LinearForm, 6> IkEnclosure::joint_effects(const FormConfiguration& q, const FormPose& T, const FormVector& v,
                                                     const Vector3d& w) const {
  // Joint i moves the tip by h_i x (tip - p_i) and h_i. What the tip does, as a moment about the world's origin and a
  // force, is carried through the joints up to the wrist, each time into axes that the joint has not turned yet.
  std::array<LinearForm, 6> effects;
  FormVector moment = form(w) + cross(T.origin, v), force = v;
  for (int i = 0; i < 5; ++i) {
    effects[i] = dot(h_[i], moment) - dot(h_[i], cross(form(p_[i]), force));
    const Turn turn(q[i]);
    const FormVector about = moment - cross(form(p_[i]), force);
    force = turned(i, turn, true, force);
    moment = turned(i, turn, true, about) + cross(form(p_[i]), force);
  }
  // Axis 6 is fixed in the tip; axes 5 and 6 meet, and 5 crosses 4 at a right angle or does not: what joint 5 does is
  // within what is left of the moment there.
  const FormVector there = form(w) + cross(T.origin - carried_point(T, meeting_), v);
  effects[5] = dot(carried_direction(T, h_[5]), there);
  LinearForm rest = squared_norm(there);
  if (wrist_sign_ != 0) rest -= squared(effects[3]);
  const double most = std::sqrt(std::max(0.0, rest.high()));
  if (effects[4].radius() > most) effects[4] = LinearForm::between(-most, most);
  return effects;
}

}  // namespace mmgrasp::detail
