// SPDX-License-Identifier: GPL-2.0-or-later
#include "io/pins.hh"

namespace mw::io {

Result<> Pins::create(hal::Hal &hal) {
    const auto id = hal.new_component("iocontrol");
    if (!id.has_value()) {
        return std::unexpected(id.error());
    }
    hal_ = &hal;
    comp_id_ = *id;
    Result<> status;
    pins_.make(hal, comp_id_, 0, status);
    if (status.has_value()) {
        status = hal.set_ready(comp_id_);
    }
    if (!status.has_value()) {
        destroy();
    }
    return status;
}

void Pins::destroy() {
    if (hal_ != nullptr) {
        static_cast<void>(hal_->delete_component(comp_id_));
        hal_ = nullptr;
    }
}

Inputs Pins::read() {
    PinInputs inputs;
    pins_.read(inputs);
    return inputs.in;
}

void Pins::write(const Outputs &outputs) {
    pins_.write(PinOutputs{outputs});
}

}  // namespace mw::io
