#include "mmgrasp/core/random.hpp"

#include <cmath>

#include "mmgrasp/core/detail/numbers.hpp"

namespace mmgrasp {
namespace {

std::uint64_t splitmix64(std::uint64_t& x) {
  std::uint64_t z = (x += 0x9e3779b97f4a7c15ull);
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ull;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebull;
  return z ^ (z >> 31);
}

std::uint64_t rotate_left(std::uint64_t x, int bits) {
  return (x << bits) | (x >> (64 - bits));
}

}  // namespace

Rng::Rng(std::uint64_t seed, std::uint64_t stream) {
  // Both words pass through the mixer, so that (1, 2) and (2, 1) or neighbouring streams share nothing.
  std::uint64_t x = seed;
  std::uint64_t y = stream ^ 0x6a09e667f3bcc909ull;
  std::uint64_t mixed = splitmix64(x) ^ rotate_left(splitmix64(y), 32);
  for (std::uint64_t& word : state_) word = splitmix64(mixed);
}

std::uint64_t Rng::next() {
  const std::uint64_t result = rotate_left(state_[1] * 5, 7) * 9;
  const std::uint64_t t = state_[1] << 17;
  state_[2] ^= state_[0];
  state_[3] ^= state_[1];
  state_[1] ^= state_[2];
  state_[0] ^= state_[3];
  state_[2] ^= t;
  state_[3] = rotate_left(state_[3], 45);
  return result;
}

double Rng::uniform() {
  return static_cast<double>(next() >> 11) * 0x1.0p-53;
}

double Rng::uniform(double lower, double upper) {
  return lower + (upper - lower) * uniform();
}

std::size_t Rng::index(std::size_t size) {
  // The product's high word; its bias is below size / 2^64.
  __extension__ using Wide = unsigned __int128;
  return static_cast<std::size_t>((static_cast<Wide>(next()) * size) >> 64);
}

double Rng::normal() {
  const double radius = std::sqrt(-2.0 * std::log(1.0 - uniform()));
  return radius * std::cos(detail::kTwoPi * uniform());
}

Eigen::VectorXd Rng::uniform(const Eigen::VectorXd& lower, const Eigen::VectorXd& upper) {
  Eigen::VectorXd values(lower.size());
  for (Eigen::Index i = 0; i < lower.size(); ++i) values[i] = uniform(lower[i], upper[i]);
  return values;
}

Eigen::Quaterniond Rng::rotation() {
  // Shoemake's subgroup method.
  const double u = uniform();
  const double a = detail::kTwoPi * uniform();
  const double b = detail::kTwoPi * uniform();
  const double s = std::sqrt(1.0 - u);
  const double t = std::sqrt(u);
  return Eigen::Quaterniond(t * std::cos(b), s * std::sin(a), s * std::cos(a), t * std::sin(b));
}

Eigen::Vector2d Rng::in_disc(double radius) {
  const double r = radius * std::sqrt(uniform());
  const double angle = detail::kTwoPi * uniform();
  return {r * std::cos(angle), r * std::sin(angle)};
}

}  // namespace mmgrasp
