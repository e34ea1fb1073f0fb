// SPDX-License-Identifier: GPL-2.0-or-later
#include "machine/tools/tool_changer.hh"

namespace mw::machine {
namespace {

constexpr std::int64_t CHANGE_TIME_NS = 100000000;

std::string text_of(ToolHand hand, std::int32_t number) {
    if (hand == ToolHand::SIMULATED) {
        return number > 0
                   ? "tool change: tool " + std::to_string(number) + " was loaded by the simulated operator"
                   : std::string("tool change: the simulated operator removed the tool");
    }
    return (number > 0 ? "tool change: load tool " + std::to_string(number) + ""
                       : std::string("tool change: remove the tool")) +
           "; confirm on a screen or with the pin hal_manualtoolchange.change_button";
}

}  // namespace

Result<> ManualToolChange::create(hal::Instance &hal, ToolHand hand, Notice notice) {
    const auto id = hal.components().create("hal_manualtoolchange");
    if (!id.has_value()) {
        return std::unexpected(id.error());
    }
    hal_ = &hal;
    comp_id_ = *id;
    hand_ = hand;
    notice_ = std::move(notice);
    Result<> status;
    change_.make(hal, comp_id_, "hal_manualtoolchange.change", hal::Dir::IN, status);
    changed_.make(hal, comp_id_, "hal_manualtoolchange.changed", hal::Dir::OUT, status);
    change_button_.make(hal, comp_id_, "hal_manualtoolchange.change_button", hal::Dir::IN, status);
    number_.make(hal, comp_id_, "hal_manualtoolchange.number", hal::Dir::IN, status);
    return status.has_value() ? hal.components().set_ready(comp_id_) : status;
}

void ManualToolChange::destroy() {
    if (hal_ != nullptr) {
        static_cast<void>(hal_->components().remove(comp_id_));
        hal_ = nullptr;
    }
}

void ManualToolChange::step(std::int64_t now_ns) {
    if (hal_ == nullptr) {
        return;
    }
    if (!change_) {
        changed_ = false;
        asked_ns_ = -1;
        confirmed_ = false;
        return;
    }
    if (asked_ns_ < 0) {
        asked_ns_ = now_ns;
        notice_(text_of(hand_, number_));
    }
    const bool done = hand_ == ToolHand::SIMULATED ? now_ns - asked_ns_ >= CHANGE_TIME_NS : confirmed_;
    changed_ = done || change_button_;
}

}  // namespace mw::machine
