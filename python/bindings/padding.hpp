#pragma once

#include "bindings.hpp"
#include "mmgrasp/collision/world.hpp"

namespace mmgrasp::python {

namespace annotations {
inline constexpr char kPadding[] =
    "float | mmgrasp.records.WorldPadding | collections.abc.Mapping[str, float | collections.abc.Mapping[str, "
    "float]]";
inline constexpr char kOptionalPadding[] =
    "float | mmgrasp.records.WorldPadding | collections.abc.Mapping[str, float | collections.abc.Mapping[str, "
    "float]] | None";
inline constexpr char kPaddingDict[] = "mmgrasp.records.WorldPadding";
}  // namespace annotations

using PaddingLike = Shown<annotations::kPadding>;
using OptionalPadding = Shown<annotations::kOptionalPadding>;
using PaddingDict = Shown<annotations::kPaddingDict>;

/// A number for all links, or a dict of Padding's fields.
Padding padding_argument(const py::object& value);
PaddingDict padding_dict(const Padding& padding);
/// The world, padded anew unless `padding` is None.
World padded(const World& world, const OptionalPadding& padding);

}  // namespace mmgrasp::python
