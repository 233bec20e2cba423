#pragma once

#include <time.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <string>
#include <vector>

namespace bench {

inline double now() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

/// Of this process, all threads together: the machine may be shared.
inline double processor_seconds() {
  timespec time{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

/// Median over `rounds` of the time one call of work() takes, in seconds: one warm-up, then measured rounds.
template <class Work>
double median_time(int rounds, const Work& work) {
  work();
  std::vector<double> times;
  for (int i = 0; i < rounds; ++i) {
    const double start = now();
    work();
    times.push_back(now() - start);
  }
  std::nth_element(times.begin(), times.begin() + rounds / 2, times.end());
  return times[rounds / 2];
}

/// One line of the result, read by run.py. `value` is the number the ratio is made of, e.g. time per query in `unit`.
struct Line {
  std::string row, on, who, unit;  ///< e.g. "free or not", "Panda, 20 boxes", "mmgrasp", "us"
  double value = 0;
  std::string more;  ///< Further JSON members, e.g. "\"hits\": 0.2, \"success\": 0.9998", or empty.
  std::string settings;
};

inline void print(const Line& line) {
  std::printf(
      "{\"row\": \"%s\", \"on\": \"%s\", \"who\": \"%s\", \"value\": %.6g, \"unit\": \"%s\"%s%s, \"settings\": "
      "\"%s\"}\n",
      line.row.c_str(), line.on.c_str(), line.who.c_str(), line.value, line.unit.c_str(), line.more.empty() ? "" : ", ",
      line.more.c_str(), line.settings.c_str());
  std::fflush(stdout);
}

}  // namespace bench
