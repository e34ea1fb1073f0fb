// SPDX-License-Identifier: GPL-2.0-or-later
// Pins and parameters of a board in HAL.
#pragma once

#include "drivers/mesa/hostmot2/pins.hh"

namespace mw::mesa {

class HalPins final : public PinSpace {
  public:
    /// Pins of the component `comp_id`, whose names begin with `prefix` and a dot.
    HalPins(int comp_id, std::string prefix) : comp_id_(comp_id), prefix_(std::move(prefix)) {}

    void *const volatile *make(const std::string &name, PinType type, Access access) override;
    void alias_param(const std::string &name, const std::string &alias) override;
    /// 0, or the negated errno of the first failure, which is in the log.
    int status() const noexcept { return status_; }

  private:
    std::string whole(const std::string &name) const {
        return name.starts_with(WHOLE_NAME) ? name.substr(1) : prefix_ + "." + name;
    }
    void keep(int status) noexcept { status_ = status_ == 0 && status < 0 ? status : status_; }

    int comp_id_;
    std::string prefix_;
    int status_ = 0;
};

}  // namespace mw::mesa
