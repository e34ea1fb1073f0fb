// SPDX-License-Identifier: GPL-2.0-or-later
// The functions of the direct bus that the servo thread runs.
#include "drivers/mesa/direct/direct_bus.hh"

#include <algorithm>
#include <array>

#include "drivers/mesa/identity/idrom.hh"

namespace mw::mesa {

namespace {

/// Number of words of the description compared in a cycle.
constexpr std::size_t COMPARED_IN_CYCLE = 16;

}  // namespace

DirectFault DirectBus::read_cycle(std::span<std::uint32_t> values) noexcept {
    if (!access_->read_list(ranges_, values_)) {
        return DirectFault::ACCESS;
    }
    cookie_ = values_[0];
    if (cookie_ != COOKIE) {
        return DirectFault::NO_COOKIE;
    }
    std::copy_n(values_.begin() + 1, std::min(values.size(), values_.size() - 1), values.begin());
    return DirectFault::NONE;
}

DirectFault DirectBus::compare_some() noexcept {
    std::array<std::uint32_t, COMPARED_IN_CYCLE> words{};
    if (!access_->read(COOKIE_ADDRESS, std::span(words).first(1))) {
        return DirectFault::ACCESS;
    }
    cookie_ = words[0];
    if (cookie_ != COOKIE) {
        return DirectFault::NO_COOKIE;
    }
    const std::size_t count = std::min(identity_.size() - compared_, COMPARED_IN_CYCLE);
    const auto address = static_cast<std::uint16_t>(idrom_address_ + 4 * compared_);
    if (!access_->read(address, std::span(words).first(count))) {
        return DirectFault::ACCESS;
    }
    if (!std::equal(words.begin(), words.begin() + static_cast<std::ptrdiff_t>(count),
                    identity_.begin() + static_cast<std::ptrdiff_t>(compared_))) {
        return DirectFault::OTHER_BOARD;
    }
    compared_ += count;
    return DirectFault::NONE;
}

void DirectBus::count(DirectFault fault) noexcept {
    fault_ = fault;
    if (fault == DirectFault::NONE) {
        failures_ = 0;
        return;
    }
    ++failed_cycles_;
    ++failures_;
    rewriting_ = true;
    if (fault == DirectFault::OTHER_BOARD || failures_ >= card_.most_failures) {
        stop();
    }
}

CycleRead DirectBus::read(std::span<std::uint32_t> values, long /*period_ns*/) noexcept {
    answered_ = false;
    if (link_ == Link::STOPPED) {
        return CycleRead::STOPPED;
    }
    const bool compares = link_ == Link::COMPARING;
    count(compares ? compare_some() : read_cycle(values));
    if (link_ == Link::STOPPED) {
        return CycleRead::STOPPED;
    }
    if (compares && compared_ == identity_.size()) {
        link_ = Link::RUNNING;
        rewriting_ = true;
    }
    answered_ = !compares && !isFailed();
    return answered_ ? CycleRead::DONE : CycleRead::FAILED;
}

bool DirectBus::write(std::span<const RegisterWrite> writes) noexcept {
    // Nothing is written without an answer in this cycle: the write would be lost, or, after a reset by the
    // operator, the driver would not have detected a bite of the watchdog.
    if (!answered_) {
        return false;
    }
    const bool done = access_->write_list(writes);
    if (!done) {
        count(DirectFault::ACCESS);
        answered_ = false;
    }
    return done;
}

bool DirectBus::redirect(int range, std::uint16_t address) noexcept {
    const auto i = static_cast<std::size_t>(range) + 1;
    const bool possible = range >= 0 && i < ranges_.size() && ranges_[i].count == 1;
    if (possible) {
        ranges_[i].address = address;
    }
    return possible;
}

bool DirectBus::take_rewrite() noexcept {
    const bool rewriting = rewriting_;
    rewriting_ = false;
    return rewriting;
}

void DirectBus::resume() noexcept {
    if (link_ == Link::STOPPED) {
        failures_ = 0;
        compared_ = 0;
        link_ = Link::COMPARING;
    }
}

}  // namespace mw::mesa
