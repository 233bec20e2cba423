#include "collision/kernels/kernels.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <vector>

#include "mmgrasp/core/detail/instruction_set.hpp"
#include "mmgrasp/core/random.hpp"

// Each loop of the collision kernels, in every version this machine runs, against plain double precision: they may err
// only towards "not sure", and only within the slack.
namespace mmgrasp::detail {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double kSlack = 1e-5;

/// Runs a test with every instruction set of this machine.
class CollisionKernels : public testing::TestWithParam<std::string> {
 protected:
  void SetUp() override { use_instruction_set(GetParam()); }
  void TearDown() override { use_instruction_set(instruction_sets().front()); }
};

INSTANTIATE_TEST_SUITE_P(Each, CollisionKernels, testing::ValuesIn(instruction_sets()),
                         [](const auto& info) { return info.param; });

Vector3d point_within(Rng& random, double half) {
  return {random.uniform(-half, half), random.uniform(-half, half), random.uniform(-half, half)};
}

Matrix3d any_rotation(Rng& random) {
  return (Eigen::AngleAxisd(random.uniform(-3, 3), Vector3d::UnitZ()) *
          Eigen::AngleAxisd(random.uniform(-3, 3), Vector3d::UnitY()) *
          Eigen::AngleAxisd(random.uniform(-3, 3), Vector3d::UnitX()))
      .toRotationMatrix();
}

struct Box {
  Matrix3d R;
  Vector3d centre, half;
  double distance(const Vector3d& p) const {
    return ((R.transpose() * (p - centre)).cwiseAbs() - half).cwiseMax(0.0).norm();
  }
};

Box any_box(Rng& random) {
  return {any_rotation(random), point_within(random, 0.8), Vector3d(0.2, 0.2, 0.2) + point_within(random, 0.15)};
}

FloatRigid to_float(const Matrix3d& R, const Vector3d& t) {
  FloatRigid out{};
  for (int i = 0; i < 9; ++i) out.R[i] = static_cast<float>(R(i / 3, i % 3));
  for (int i = 0; i < 3; ++i) out.t[i] = static_cast<float>(t[i]);
  return out;
}

/// Spheres as a CoverView wants them: padded to whole vectors with spheres far away.
struct Cover {
  std::vector<float> x, y, z, outer, inner;
  int filled = 0;
  void add(const Vector3d& p, double outer_radius, double inner_radius) {
    x.push_back(static_cast<float>(p.x()));
    y.push_back(static_cast<float>(p.y()));
    z.push_back(static_cast<float>(p.z()));
    outer.push_back(static_cast<float>(outer_radius));
    inner.push_back(static_cast<float>(inner_radius));
    ++filled;
  }
  CoverView view() {
    while (x.size() % kLanes != 0) {
      for (auto* v : {&x, &y, &z}) v->push_back(1e6f);
      outer.push_back(0);
      inner.push_back(-1);
    }
    return {x.data(), y.data(), z.data(), outer.data(), inner.data(), static_cast<int>(x.size()), filled};
  }
  Vector3d centre(int i) const { return {x[i], y[i], z[i]}; }
};

TEST_P(CollisionKernels, TheFarthestPointIsTheFirstOfTheFarthest) {
  Rng random(12);
  for (int round = 0; round < 500; ++round) {
    const int count = kLanes * (1 + static_cast<int>(random.index(20)));
    std::vector<double> points;
    // Few values, so that points are equally far now and then.
    for (int i = 0; i < 3 * count; ++i) points.push_back(std::round(random.uniform(-4, 4)) / 8);
    const std::vector<float> rough(points.begin(), points.end());
    Vector3d d = point_within(random, 1);
    if (round % 2 == 0) d = Vector3d(std::round(4 * d[0]), std::round(4 * d[1]), 1);
    const auto along = [&](int i) {
      return d[0] * points[i] + d[1] * points[count + i] + d[2] * points[2 * count + i];
    };
    int best = 0;
    for (int i = 1; i < count; ++i) {
      if (along(i) > along(best)) best = i;
    }
    const Eigen::Vector3f rough_d = d.cast<float>();
    const int nearly = kernels().nearly_farthest(rough.data(), count, rough_d.data());
    ASSERT_LE(along(best) - along(nearly), 1e-6);
    // Sums of such numbers are exact.
    if (round % 2 == 0) {
      ASSERT_EQ(nearly, best);
      ASSERT_EQ(kernels().farthest(points.data(), count, d.data()), best);
    } else {
      ASSERT_LE(along(best) - along(kernels().farthest(points.data(), count, d.data())), 1e-14);
    }
  }
}

TEST_P(CollisionKernels, SpheresFollowTheirFrames) {
  Rng random(3);
  for (int round = 0; round < 200; ++round) {
    Eigen::Isometry3d frames[2] = {Eigen::Isometry3d::Identity(), Eigen::Isometry3d::Identity()};
    frames[1].linear() = any_rotation(random);
    frames[1].translation() = point_within(random, 3);
    const FrameSphere sphere{{0.1, -0.2, 0.3}, 0.07, 1};
    float placed[4];
    kernels().place_spheres(&sphere, 1, frames[0].data(), placed, 1);
    const Vector3d centre = frames[1] * Vector3d(0.1, -0.2, 0.3);
    const double moved_by = (Vector3d(placed[0], placed[1], placed[2]) - centre).norm();
    EXPECT_GE(placed[3], 0.07 + moved_by);  // what rounding moved, the radius makes good
    EXPECT_LT(placed[3], 0.07 + 3e-6 * (3 * centre.norm() + 0.07));
  }
}

TEST_P(CollisionKernels, SpheresMeetBoxesWhenTheyDo) {
  Rng random(5);
  int met = 0, apart = 0;
  for (int round = 0; round < 300; ++round) {
    BoxPack packs[2] = {};
    std::vector<Box> boxes;
    for (BoxPack& pack : packs) {
      for (int lane = 0; lane < kLanes; ++lane) {
        const Box box = any_box(random);
        boxes.push_back(box);
        for (int k = 0; k < 9; ++k) pack.axes[k][lane] = static_cast<float>(box.R.transpose()(k / 3, k % 3));
        for (int k = 0; k < 3; ++k) {
          pack.centre[k][lane] = static_cast<float>(box.centre[k]);
          pack.half[k][lane] = static_cast<float>(box.half[k]);
        }
        pack.radius[lane] = static_cast<float>(box.half.norm() * (1 + 1e-6));
      }
    }
    const Vector3d centre = point_within(random, 1).cast<float>().cast<double>();
    const double radius = static_cast<float>(random.uniform(0.05, 0.5));
    float numbers[4] = {static_cast<float>(centre.x()), static_cast<float>(centre.y()), static_cast<float>(centre.z()),
                        static_cast<float>(radius)};
    const SphereRows sphere{numbers, numbers + 1, numbers + 2, numbers + 3};
    std::uint8_t masks[2] = {};
    kernels().spheres_meet_boxes(packs, 2, sphere, 1, masks);
    float squared[2 * kLanes];
    const float nearest = kernels().boxes_from_point(packs, 2, *sphere.x, *sphere.y, *sphere.z, squared);
    double least = 1e9;
    for (int i = 0; i < 16; ++i) {
      const double distance = boxes[i].distance(centre);
      least = std::min(least, distance);
      const bool said = (masks[i / kLanes] >> (i % kLanes) & 1) != 0;
      if (distance < radius - kSlack) {
        EXPECT_TRUE(said) << distance << " " << radius;
      }
      if (distance > radius + kSlack) {
        EXPECT_FALSE(said) << distance << " " << radius;
      }
      ++(said ? met : apart);
    }
    EXPECT_NEAR(nearest, least * least, kSlack);
  }
  EXPECT_GT(met, 300);
  EXPECT_GT(apart, 300);
}

TEST_P(CollisionKernels, PairsOfSpheresMeetWhenTheyDo) {
  Rng random(9);
  constexpr int kSpheres = 21;
  int met = 0, apart = 0;
  for (int round = 0; round < 200; ++round) {
    constexpr int kRow = 24;
    std::vector<float> numbers(4 * kRow);
    const SphereRows spheres{&numbers[0], &numbers[kRow], &numbers[2 * kRow], &numbers[3 * kRow]};
    for (int i = 0; i < 3 * kRow; ++i) numbers[i] = static_cast<float>(random.uniform(-1, 1));
    for (int i = 3 * kRow; i < 4 * kRow; ++i) numbers[i] = static_cast<float>(random.uniform(0.05, 0.6));
    std::vector<PairBlock> blocks;
    for (int i = 0; i < kSpheres; ++i) {
      const int first = static_cast<int>(random.index(3)) * kLanes;
      // Lanes beyond the last sphere belong to no pair.
      const unsigned lanes = first + kLanes > kSpheres ? (1u << (kSpheres - first)) - 1 : 0xffu;
      blocks.push_back({i, first, static_cast<std::uint8_t>(random.index(256) & lanes)});
    }
    std::vector<std::uint8_t> masks(blocks.size());
    kernels().sphere_pairs_meet(blocks.data(), kSpheres, spheres, masks.data());
    for (std::size_t b = 0; b < blocks.size(); ++b) {
      for (int lane = 0; lane < kLanes; ++lane) {
        const bool said = (masks[b] >> lane & 1) != 0;
        if ((blocks[b].lanes >> lane & 1) == 0) {
          EXPECT_FALSE(said);
          continue;
        }
        const int i = blocks[b].sphere, k = blocks[b].first + lane;
        const double clearance =
            std::hypot(spheres.x[i] - spheres.x[k], spheres.y[i] - spheres.y[k], spheres.z[i] - spheres.z[k]) -
            spheres.radius[i] - spheres.radius[k];
        if (std::abs(clearance) > kSlack) {
          EXPECT_EQ(said, clearance < 0);
        }
        ++(said ? met : apart);
      }
    }
  }
  EXPECT_GT(met, 1000);
  EXPECT_GT(apart, 1000);
}

TEST_P(CollisionKernels, CoverAgainstBoxIsNeverSureAndWrong) {
  Rng random(7);
  int answers[3] = {};
  for (int round = 0; round < 3000; ++round) {
    Cover cover;
    for (int i = 0; i < 11; ++i) {
      const double inner = random.uniform(-0.05, 0.05);
      cover.add(point_within(random, 0.2), std::max(inner, 0.0) + random.uniform(0.005, 0.05), inner);
    }
    Box box = any_box(random);
    box.centre *= 0.6;
    const float half[3] = {static_cast<float>(box.half[0]), static_cast<float>(box.half[1]),
                           static_cast<float>(box.half[2])};
    const double grow = random.uniform(0, 0.01);
    const CoverView view = cover.view();
    const auto ask = [&](bool seek_overlap) {
      return kernels().cover_meets_box(view, to_float(box.R, box.centre), half, static_cast<float>(grow),
                                       static_cast<float>(kSlack), seek_overlap);
    };
    const CoverAnswer answer = ask(true);
    EXPECT_EQ(ask(false) == kApart, answer == kApart);
    ++answers[answer];
    bool outer_meets = false, inner_meets = false, outer_far = true;
    for (int i = 0; i < cover.filled; ++i) {
      const double distance = box.distance(cover.centre(i));
      outer_meets |= distance <= cover.outer[i] + grow;
      outer_far &= distance > cover.outer[i] + grow + 2 * kSlack;
      inner_meets |= cover.inner[i] > 0 && distance < cover.inner[i];
    }
    if (outer_meets) {
      EXPECT_NE(answer, kApart);
    }
    if (outer_far) {
      EXPECT_EQ(answer, kApart);
    }
    if (!inner_meets) {
      EXPECT_NE(answer, kOverlap);
    }
  }
  for (const int count : answers) EXPECT_GT(count, 100);
}

/// Two levels: big spheres, each with eight small ones inside it.
struct TwoLevels {
  TwoLevels(Rng& random, double within, double inner) {
    for (int i = 0; i < kLanes; ++i) {
      const Vector3d centre = point_within(random, within);
      coarse.add(centre, 0.06, -1);
      for (int k = 0; k < kLanes; ++k) fine.add(centre + point_within(random, 0.02), 0.02, inner);
    }
    views[0] = coarse.view();
    views[1] = fine.view();
  }
  Cover coarse, fine;
  CoverView views[2];
};

/// What spheres of a cover may be found: `least` is the smallest clearance of their outer spheres, those above
/// `surely_apart` must be proven separate; `overlap_possible`: an inner sphere meets the body.
void expect_never_sure_and_wrong(CoverAnswer answer, double least, double surely_apart, bool overlap_possible) {
  if (least < 0) {
    EXPECT_NE(answer, kApart);
  }
  if (least > surely_apart) {
    EXPECT_EQ(answer, kApart);
  }
  if (!overlap_possible) {
    EXPECT_NE(answer, kOverlap);
  }
}

/// The grid of a sphere of radius 0.2 about the origin. Each cell holds the distance of its centre, or a lower bound of
/// all distances within it.
void grid_is_never_sure_and_wrong(bool of_centres) {
  constexpr int kCount = 24;
  constexpr double kLow = -0.36, kStep = 0.03, kRadius = 0.2, kQuantum = 0.004;
  std::vector<std::int8_t> cells(kCount * kCount * kCount);
  for (int i = 0; i < kCount; ++i)
    for (int j = 0; j < kCount; ++j)
      for (int k = 0; k < kCount; ++k) {
        const Vector3d centre(kLow + (i + 0.5) * kStep, kLow + (j + 0.5) * kStep, kLow + (k + 0.5) * kStep);
        const double reach = 0.5 * std::sqrt(3.0) * kStep, d = centre.norm() - kRadius;
        const double units = d + reach < 0 ? -1 : std::max(0.0, of_centres ? d : d - reach) / kQuantum;
        cells[(i * kCount + j) * kCount + k] = static_cast<std::int8_t>(std::min(127.0, std::floor(units)));
      }
  GridView grid{};
  for (int k = 0; k < 3; ++k) {
    grid.low[k] = static_cast<float>(kLow);
    grid.half[k] = static_cast<float>(kRadius);
    grid.count[k] = kCount;
  }
  grid.per_step = static_cast<float>(1 / kStep);
  grid.quantum = static_cast<float>(kQuantum);
  grid.spread = of_centres ? static_cast<float>(kStep) : 0;
  grid.cells = cells.data();
  Rng random(11);
  int answers[3] = {};
  for (int round = 0; round < 4000; ++round) {
    const TwoLevels levels(random, 0.12, round % 2 == 0 ? 0.01 : -1);
    const Cover& fine = levels.fine;
    const Matrix3d R = any_rotation(random);
    const Vector3d t = point_within(random, 0.4);
    const auto ask = [&](bool seek_overlap) {
      return kernels().cover_tree_meets_grid(grid, levels.views, 2, to_float(R, t), 0, static_cast<float>(kSlack),
                                             seek_overlap);
    };
    const CoverAnswer answer = ask(true);
    EXPECT_EQ(ask(false) == kApart, answer == kApart);
    ++answers[answer];
    double least = 1e9, least_centre = 1e9;
    for (int i = 0; i < fine.filled; ++i) {
      const double d = (R * fine.centre(i) + t).norm() - kRadius;
      least = std::min(least, d - fine.outer[i]);
      if (fine.inner[i] > 0) least_centre = std::min(least_centre, d);
    }
    const double surely_apart = (of_centres ? 1 : 2) * std::sqrt(3.0) * kStep + kQuantum;
    expect_never_sure_and_wrong(answer, least, surely_apart, least_centre <= 0);
  }
  for (const int count : answers) EXPECT_GT(count, 100);
}

TEST_P(CollisionKernels, LevelsOfCoversAgainstBoxAreNeverSureAndWrong) {
  Rng random(13);
  int answers[3] = {};
  for (int round = 0; round < 3000; ++round) {
    const TwoLevels levels(random, 0.2, round % 2 == 0 ? 0.01 : -1);
    const Cover& fine = levels.fine;
    Box box = any_box(random);
    box.centre *= 0.6;
    const float half[3] = {static_cast<float>(box.half[0]), static_cast<float>(box.half[1]),
                           static_cast<float>(box.half[2])};
    const auto ask = [&](bool seek_overlap) {
      return kernels().cover_tree_meets_box(levels.views, 2, to_float(box.R, box.centre), half, 0,
                                            static_cast<float>(kSlack), seek_overlap);
    };
    const CoverAnswer answer = ask(true);
    EXPECT_EQ(ask(false) == kApart, answer == kApart);
    ++answers[answer];
    double least = 1e9, least_inner = 1e9;
    for (int i = 0; i < fine.filled; ++i) {
      const double d = box.distance(fine.centre(i));
      least = std::min(least, d - fine.outer[i]);
      if (fine.inner[i] > 0) least_inner = std::min(least_inner, d - fine.inner[i]);
    }
    expect_never_sure_and_wrong(answer, least, 2 * kSlack, least_inner <= 0);
  }
  for (const int count : answers) EXPECT_GT(count, 100);
}

TEST_P(CollisionKernels, GridOfCellsIsNeverSureAndWrong) {
  grid_is_never_sure_and_wrong(false);
}

TEST_P(CollisionKernels, GridOfCentresIsNeverSureAndWrong) {
  grid_is_never_sure_and_wrong(true);
}

}  // namespace
}  // namespace mmgrasp::detail
