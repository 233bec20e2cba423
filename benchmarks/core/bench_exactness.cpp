// 100,000 answers against FCL called directly: six robots in five kinds of scene. Prints the counts of each pairing and
// lists what lies within 1e-6 m of touching; leaves with 1 when an answer outside that band differs.

#include <cstdlib>

#include "mmgrasp/core/parallel.hpp"
#include "report.hpp"
#include "support/exactness.hpp"

int main(int argc, char** argv) {
  const int queries = argc > 1 ? std::atoi(argv[1]) : 100000;
  const std::vector<exactness::MeshArm> arms = exactness::six_arms();
  constexpr std::size_t kScenes = 5;
  std::vector<exactness::Count> counts(arms.size() * kScenes);
  std::vector<std::string> names(counts.size());
  mmgrasp::parallel_for(counts.size(), mmgrasp::resolve_threads(0), [&](std::size_t i, int) {
    const exactness::MeshArm& arm = arms[i / kScenes];
    const exactness::Scene scene = exactness::scenes(arm)[i % kScenes];
    names[i] = arm.name + ", " + scene.name;
    exactness::compare(arm, scene, queries / static_cast<int>(counts.size()) + 1, static_cast<unsigned>(1000 + i),
                       counts[i]);
  });
  std::size_t wrong = 0;
  for (std::size_t i = 0; i < counts.size(); ++i) {
    const exactness::Count& count = counts[i];
    char more[200];
    std::snprintf(more, sizeof more,
                  "\"free\": %d, \"self\": %d, \"scene\": %d, \"in the 1e-6 m band\": %zu, \"wrong\": %zu", count.free,
                  count.self, count.scene, count.band.size(), count.wrong.size());
    bench::print({"exactness", names[i], "mmgrasp", "queries agreed on with FCL",
                  static_cast<double>(count.free + count.self + count.scene), more,
                  "half drawn at random, half within a millimetre of touching"});
    for (const std::string& line : count.band) std::printf("band: %s\n", line.c_str());
    for (const std::string& line : count.wrong) std::printf("WRONG: %s\n", line.c_str());
    wrong += count.wrong.size();
  }
  return wrong == 0 ? 0 : 1;
}
