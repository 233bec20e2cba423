#pragma once

#include <fstream>
#include <map>
#include <set>
#include <sstream>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "mmgrasp/collision/checker.hpp"

namespace bench {

/// A problem of the text that mbm_text.py writes.
struct MbmProblem {
  std::string set, name;
  mmgrasp::JointGroup group;
  mmgrasp::World world;
  Eigen::VectorXd start;
  std::vector<Eigen::VectorXd> goals;
};

/// Reads the problems and gives each the robot with the links its scene allows to touch.
class MbmReader {
 public:
  explicit MbmReader(const std::string& file) : in_(file) {
    if (!in_) throw std::runtime_error(file + ": cannot be read");
  }

  std::vector<MbmProblem> read() {
    std::vector<MbmProblem> out;
    std::string line;
    while (std::getline(in_, line)) {
      std::istringstream words(line);
      std::string what;
      words >> what;
      if (what == "robot") {
        std::string urdf, srdf;
        words >> urdf >> srdf;
        robot_.emplace_back(mmgrasp::Robot::load(urdf, srdf));
      } else if (what == "problem") {
        finish(out);
        entry_ = {};
        words >> entry_.name >> entry_.group;
      } else if (what == "start") {
        add_value(words, entry_.start);
      } else if (what == "goal") {
        add_value(words, entry_.goals.back());
      } else if (what == "another_goal") {
        entry_.goals.emplace_back();
      } else if (what == "allow") {
        std::string a, b;
        words >> a >> b;
        entry_.allowed.insert({a, b});
      } else if (what == "shape") {
        add_shape(words);
      }
    }
    finish(out);
    return out;
  }

 private:
  struct Entry {
    std::string name, group;
    std::map<std::string, double> start;
    std::vector<std::map<std::string, double>> goals{1};
    std::set<std::pair<std::string, std::string>> allowed;
    std::map<std::string, mmgrasp::WorldObject> objects;
  };

  static void add_value(std::istringstream& words, std::map<std::string, double>& values) {
    std::string joint;
    double value = 0;
    words >> joint >> value;
    values[joint] = value;
  }

  void add_shape(std::istringstream& words) {
    std::string object, kind;
    words >> object >> kind;
    double a = 0, b = 0, c = 0;
    mmgrasp::Shape shape = mmgrasp::Sphere{0.1};
    if (kind == "box") {
      words >> a >> b >> c;
      shape = mmgrasp::Box{{a, b, c}};
    } else if (kind == "cylinder") {
      words >> a >> b;
      shape = mmgrasp::Cylinder{a, b};
    } else {
      words >> a;
      shape = mmgrasp::Sphere{a};
    }
    mmgrasp::Pose T = mmgrasp::Pose::Identity();
    for (int r = 0; r < 3; ++r) {
      for (int k = 0; k < 4; ++k) words >> T.matrix()(r, k);
    }
    mmgrasp::LinkShape placed;
    placed.shape = shape;
    placed.T_link_shape = T;
    entry_.objects[object].shapes.push_back(placed);
  }

  static Eigen::VectorXd of_group(const mmgrasp::JointGroup& group, const std::map<std::string, double>& values) {
    Eigen::VectorXd q(group.size());
    for (int i = 0; i < group.size(); ++i) q[i] = values.at(group.names()[i]);
    return q;
  }

  void finish(std::vector<MbmProblem>& out) {
    if (entry_.name.empty()) return;
    using namespace mmgrasp;
    const Robot& robot = robot_.back();
    auto pairs = robot.disabled_pairs();
    std::map<std::string, int> links;
    for (std::size_t i = 0; i < robot.links().size(); ++i) links[robot.links()[i].name] = static_cast<int>(i);
    for (const auto& [a, b] : entry_.allowed) {
      if (!links.count(a) || !links.count(b)) continue;
      pairs.emplace(std::minmax(links[a], links[b]), DisabledReason::user);
    }
    JointGroup group = robot.with_disabled_pairs(pairs).group(entry_.group);
    Eigen::VectorXd reference = group.reference();
    for (std::size_t j = 0; j < robot.joints().size(); ++j) {
      const int index = robot.joints()[j].value_index;
      const auto value = entry_.start.find(robot.joints()[j].name);
      if (index >= 0 && value != entry_.start.end()) reference[index] = value->second;
    }
    MbmProblem problem{entry_.name.substr(0, entry_.name.find('/')),
                       entry_.name,
                       group.with_reference(reference),
                       {},
                       of_group(group, entry_.start),
                       {}};
    for (const auto& goal : entry_.goals) problem.goals.push_back(of_group(group, goal));
    for (const auto& [name, object] : entry_.objects) problem.world.add(name, object);
    out.push_back(std::move(problem));
  }

  std::ifstream in_;
  std::vector<mmgrasp::Robot> robot_;
  Entry entry_;
};

}  // namespace bench
