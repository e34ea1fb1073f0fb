// SPDX-License-Identifier: GPL-2.0-or-later
// Loading and unloading of a board.
#include "drivers/mesa/epp/epp_registers.hh"

namespace mw::mesa::epp {

EppRegisters::EppRegisters(std::unique_ptr<Port> port, Width width) : port_(std::move(port)), width_(width) {
    begin();
}

EppRegisters::~EppRegisters() = default;

}  // namespace mw::mesa::epp
