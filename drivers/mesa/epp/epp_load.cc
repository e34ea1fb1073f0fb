// SPDX-License-Identifier: GPL-2.0-or-later
// What happens while a board is loaded and unloaded.
#include "drivers/mesa/epp/epp_registers.hh"

namespace mw::mesa::epp {

EppRegisters::EppRegisters(std::unique_ptr<Port> port, Width width) : port_(std::move(port)), width_(width) {
    begin();
}

EppRegisters::~EppRegisters() = default;

}  // namespace mw::mesa::epp
