// SPDX-License-Identifier: GPL-2.0-or-later
#include <memory>

#include "gcode/canon/machine_canon.hh"

namespace mw::gcode {

MachineCall::MachineCall() = default;
MachineCall::MachineCall(const MachineCall &other) = default;
MachineCall::MachineCall(MachineCall &&other) noexcept = default;
MachineCall::~MachineCall() = default;

MachineCall &MachineCall::operator=(const MachineCall &other) {
    return *this = MachineCall(other);
}

/// Constructs the alternative again. An assignment operator for each pair of alternatives would take long to
/// compile.
MachineCall &MachineCall::operator=(MachineCall &&other) noexcept {
    if (this != &other) {
        std::destroy_at(this);
        std::construct_at(this, std::move(other));
    }
    return *this;
}

}  // namespace mw::gcode
