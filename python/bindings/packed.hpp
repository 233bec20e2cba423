#pragma once

#include <pybind11/pybind11.h>

#include <Eigen/Geometry>
#include <array>
#include <cstring>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <tuple>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include "plain_fields.hpp"

namespace mmgrasp::python {

/// What stands for a C++ value in a pickle: tuples, numbers and bytes, to the last bit. Plain structs (kFields) go
/// member by member.
template <typename T>
struct Packed {
  static pybind11::object from(const T& value) {
    if constexpr (kFields < T >> 0) {
      return std::apply(
          [](const auto&... f) { return pybind11::make_tuple(Packed<std::decay_t<decltype(f)>>::from(f)...); },
          plain_fields(value));
    } else if constexpr (std::is_enum_v<T>) {
      return pybind11::int_(static_cast<long long>(value));
    } else {
      static_assert(std::is_arithmetic_v<T>, "neither a number nor a plain struct: needs a Packed of its own");
      return pybind11::cast(value);
    }
  }
  static T to(const pybind11::handle& state) {
    if constexpr (kFields < T >> 0) {
      const auto values = pybind11::cast<pybind11::tuple>(state);
      if (values.size() != kFields<T>) throw pybind11::type_error("a pickle of another version of mmgrasp");
      T made{};
      auto members = plain_fields(made);
      assign(members, values, std::make_index_sequence<kFields<T>>());
      return made;
    } else if constexpr (std::is_enum_v<T>) {
      return static_cast<T>(pybind11::cast<long long>(state));
    } else {
      return pybind11::cast<T>(state);
    }
  }

 private:
  template <typename Members, std::size_t... I>
  static void assign(Members& members, const pybind11::tuple& values, std::index_sequence<I...>) {
    ((std::get<I>(members) = Packed<std::decay_t<std::tuple_element_t<I, Members>>>::to(values[I])), ...);
  }
};

template <typename T>
pybind11::object packed(const T& value) {
  return Packed<T>::from(value);
}

template <>
struct Packed<std::monostate> {
  static pybind11::object from(std::monostate) { return pybind11::none(); }
  static std::monostate to(const pybind11::handle&) { return {}; }
};

template <>
struct Packed<std::string> {  // paths need not be UTF-8
  static pybind11::object from(const std::string& value) { return pybind11::bytes(value); }
  static std::string to(const pybind11::handle& state) {
    return static_cast<std::string>(pybind11::cast<pybind11::bytes>(state));
  }
};

/// The bytes of numbers as they lie in memory.
template <typename Number>
pybind11::bytes packed_numbers(const Number* numbers, std::size_t count) {
  return pybind11::bytes(reinterpret_cast<const char*>(numbers), count * sizeof(Number));
}
template <typename Number>
void unpack_numbers(const pybind11::handle& state, Number* numbers, std::size_t count) {
  const auto text = static_cast<std::string>(pybind11::cast<pybind11::bytes>(state));
  if (text.size() != count * sizeof(Number)) throw pybind11::type_error("a pickle of another version of mmgrasp");
  if (count > 0) std::memcpy(static_cast<void*>(numbers), text.data(), text.size());
}

template <typename Number, int Rows, int Columns, int Options, int MaxRows, int MaxColumns>
struct Packed<Eigen::Matrix<Number, Rows, Columns, Options, MaxRows, MaxColumns>> {
  using M = Eigen::Matrix<Number, Rows, Columns, Options, MaxRows, MaxColumns>;
  static pybind11::object from(const M& m) {
    return pybind11::make_tuple(m.rows(), m.cols(), packed_numbers(m.data(), static_cast<std::size_t>(m.size())));
  }
  static M to(const pybind11::handle& state) {
    const auto values = pybind11::cast<pybind11::tuple>(state);
    const auto rows = pybind11::cast<Eigen::Index>(values[0]), columns = pybind11::cast<Eigen::Index>(values[1]);
    if ((Rows >= 0 && rows != Rows) || (Columns >= 0 && columns != Columns) || rows < 0 || columns < 0)
      throw pybind11::type_error("a pickle of another version of mmgrasp");
    M m;
    if constexpr (Rows < 0 || Columns < 0) m.resize(rows, columns);
    unpack_numbers(values[2], m.data(), static_cast<std::size_t>(m.size()));
    return m;
  }
};

template <>
struct Packed<Eigen::Isometry3d> {
  static pybind11::object from(const Eigen::Isometry3d& T) { return packed(Eigen::Matrix4d(T.matrix())); }
  static Eigen::Isometry3d to(const pybind11::handle& state) {
    return Eigen::Isometry3d(Packed<Eigen::Matrix4d>::to(state));
  }
};

template <>
struct Packed<Eigen::AlignedBox3d> {
  static pybind11::object from(const Eigen::AlignedBox3d& box) {
    return pybind11::make_tuple(packed(Eigen::Vector3d(box.min())), packed(Eigen::Vector3d(box.max())));
  }
  static Eigen::AlignedBox3d to(const pybind11::handle& state) {
    const auto ends = pybind11::cast<pybind11::tuple>(state);
    Eigen::AlignedBox3d box;
    box.min() = Packed<Eigen::Vector3d>::to(ends[0]);
    box.max() = Packed<Eigen::Vector3d>::to(ends[1]);
    return box;
  }
};

template <typename T>
inline constexpr bool kLiesAsNumbers = std::is_arithmetic_v<T> && !std::is_same_v<T, bool>;
template <typename Number, std::size_t N>
inline constexpr bool kLiesAsNumbers<std::array<Number, N>> = std::is_arithmetic_v<Number>;
template <typename Number, int N>
inline constexpr bool kLiesAsNumbers<Eigen::Matrix<Number, N, 1>> = N > 0;

template <typename T>
struct Packed<std::vector<T>> {
  static pybind11::object from(const std::vector<T>& values) {
    if constexpr (kLiesAsNumbers<T>) {
      return pybind11::make_tuple(values.size(), packed_numbers(values.data(), values.size()));
    } else {
      pybind11::tuple all(values.size());
      for (std::size_t i = 0; i < values.size(); ++i) all[i] = Packed<T>::from(values[i]);
      return std::move(all);
    }
  }
  static std::vector<T> to(const pybind11::handle& state) {
    const auto all = pybind11::cast<pybind11::tuple>(state);
    std::vector<T> values;
    if constexpr (kLiesAsNumbers<T>) {
      const auto bytes = static_cast<std::size_t>(pybind11::len(all[1]));
      values.resize(bytes / sizeof(T));
      unpack_numbers(all[1], values.data(), values.size());
    } else {
      values.reserve(all.size());
      for (const pybind11::handle one : all) values.push_back(Packed<T>::to(one));
    }
    return values;
  }
};

template <typename T>
struct Packed<std::optional<T>> {
  static pybind11::object from(const std::optional<T>& value) {
    return value ? pybind11::object(pybind11::make_tuple(Packed<T>::from(*value))) : pybind11::none();
  }
  static std::optional<T> to(const pybind11::handle& state) {
    if (state.is_none()) return std::nullopt;
    return Packed<T>::to(pybind11::cast<pybind11::tuple>(state)[0]);
  }
};

template <typename T>
struct Packed<std::shared_ptr<const T>> {
  static pybind11::object from(const std::shared_ptr<const T>& value) {
    return value ? pybind11::object(pybind11::make_tuple(Packed<T>::from(*value))) : pybind11::none();
  }
  static std::shared_ptr<const T> to(const pybind11::handle& state) {
    if (state.is_none()) return nullptr;
    return std::make_shared<const T>(Packed<T>::to(pybind11::cast<pybind11::tuple>(state)[0]));
  }
};

template <typename A, typename B>
struct Packed<std::pair<A, B>> {
  static pybind11::object from(const std::pair<A, B>& value) {
    return pybind11::make_tuple(Packed<A>::from(value.first), Packed<B>::from(value.second));
  }
  static std::pair<A, B> to(const pybind11::handle& state) {
    const auto values = pybind11::cast<pybind11::tuple>(state);
    return {Packed<A>::to(values[0]), Packed<B>::to(values[1])};
  }
};

template <typename T, std::size_t N>
struct Packed<std::array<T, N>> {
  static pybind11::object from(const std::array<T, N>& values) {
    pybind11::tuple all(N);
    for (std::size_t i = 0; i < N; ++i) all[i] = Packed<T>::from(values[i]);
    return std::move(all);
  }
  static std::array<T, N> to(const pybind11::handle& state) {
    const auto all = pybind11::cast<pybind11::tuple>(state);
    std::array<T, N> values{};
    for (std::size_t i = 0; i < N; ++i) values[i] = Packed<T>::to(all[i]);
    return values;
  }
};

/// Maps and sets, as vectors of what they hold.
template <typename Container, typename Entry>
struct PackedEntries {
  static pybind11::object from(const Container& values) {
    return packed(std::vector<Entry>(values.begin(), values.end()));
  }
  static Container to(const pybind11::handle& state) {
    const auto entries = Packed<std::vector<Entry>>::to(state);
    return Container(entries.begin(), entries.end());
  }
};
template <typename K, typename V>
struct Packed<std::map<K, V>> : PackedEntries<std::map<K, V>, std::pair<K, V>> {};
template <typename K>
struct Packed<std::set<K>> : PackedEntries<std::set<K>, K> {};

template <typename... Kinds>
struct Packed<std::variant<Kinds...>> {
  using V = std::variant<Kinds...>;
  static pybind11::object from(const V& value) {
    return std::visit(
        [&](const auto& one) {
          return pybind11::make_tuple(value.index(), Packed<std::decay_t<decltype(one)>>::from(one));
        },
        value);
  }
  static V to(const pybind11::handle& state) {
    const auto values = pybind11::cast<pybind11::tuple>(state);
    const auto index = pybind11::cast<std::size_t>(values[0]);
    V made;
    if (index >= sizeof...(Kinds)) throw pybind11::type_error("a pickle of another version of mmgrasp");
    std::size_t at = 0;
    ((at++ == index ? void(made = Packed<Kinds>::to(values[1])) : void()), ...);
    return made;
  }
};

}  // namespace mmgrasp::python
