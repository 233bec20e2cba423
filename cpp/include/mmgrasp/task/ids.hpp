#pragma once

#include "mmgrasp/core/export.hpp"

namespace mmgrasp {

/// Index of a tray in PartSupplyProblem::trays, and of its region in every list that holds one region a tray. A number
/// becomes a TrayId only by naming the type, so that no other index is taken for one; a TrayId may be used wherever an
/// index is wanted. Python has plain int instead.
class MMGRASP_EXPORT TrayId {
 public:
  constexpr TrayId() = default;  ///< No tray.
  constexpr explicit TrayId(int index) : index_(index) {}
  constexpr operator int() const { return index_; }

 private:
  int index_ = -1;
};

/// One part of a PartSupplyProblem.
struct MMGRASP_EXPORT PartRef {
  TrayId tray;
  int part = -1;  ///< Index into Tray::parts.
};

inline bool operator==(const PartRef& a, const PartRef& b) {
  return a.tray == b.tray && a.part == b.part;
}
inline bool operator!=(const PartRef& a, const PartRef& b) {
  return !(a == b);
}
/// Orders parts by tray, then by part.
inline bool operator<(const PartRef& a, const PartRef& b) {
  return a.tray != b.tray ? a.tray < b.tray : a.part < b.part;
}

}  // namespace mmgrasp
