// SPDX-License-Identifier: GPL-2.0-or-later
#include <memory>

#include "gcode/canon/canon_calls.hh"

namespace mw::gcode {

CanonCall::CanonCall() = default;
CanonCall::CanonCall(const CanonCall &other) = default;
CanonCall::CanonCall(CanonCall &&other) noexcept = default;
CanonCall::~CanonCall() = default;

CanonCall &CanonCall::operator=(const CanonCall &other) {
    return *this = CanonCall(other);
}

/// Constructs the alternative again. An assignment operator for each pair of alternatives would take long to
/// compile.
CanonCall &CanonCall::operator=(CanonCall &&other) noexcept {
    if (this != &other) {
        std::destroy_at(this);
        std::construct_at(this, std::move(other));
    }
    return *this;
}

}  // namespace mw::gcode
