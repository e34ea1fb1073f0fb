// SPDX-License-Identifier: GPL-2.0-or-later
// Removes components of dead processes and records their names.
#include <time.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

#include "hal/core/detail/impl.hh"

namespace mw::hal {

using namespace detail;

void Hal::Impl::note_death(const CompRecord &comp) noexcept {
    if (comp.end_requested) {
        return;
    }
    Header &header = segment.header();
    DeathRecord &death = header.deaths[header.death_count % DEATHS];
    death.name = comp.name;
    death.pid = comp.process.pid;
    timespec now{};
    ::clock_gettime(CLOCK_MONOTONIC, &now);
    death.time_ns = now.tv_sec * 1'000'000'000LL + now.tv_nsec;
    ++header.death_count;
}

std::vector<DeathInfo> Hal::deaths() const {
    Guard guard(*impl_);
    const Header &header = impl_->segment.header();
    std::vector<DeathInfo> deaths;
    const std::uint32_t kept = std::min<std::uint32_t>(header.death_count, DEATHS);
    for (std::uint32_t i = header.death_count - kept; i != header.death_count; ++i) {
        const DeathRecord &death = header.deaths[i % DEATHS];
        const std::string name = death.name.data();
        // Only the last death of a component counts, and none of a restarted one.
        std::erase_if(deaths, [&](const DeathInfo &earlier) { return earlier.name == name; });
        if (impl_->segment.find(Kind::COMP, name) == nullptr) {
            deaths.push_back({name, death.pid, death.time_ns});
        }
    }
    return deaths;
}

std::vector<std::string> Hal::reap_dead_components() {
    Guard guard(*impl_);
    std::vector<std::string> names;
    const runtime::ProcessId self = runtime::this_process();
    const std::int32_t spared_pid = impl_->segment.header().spared_pid;
    impl_->segment.each<CompRecord>(Kind::COMP, [&](CompRecord &comp) {
        const bool skipped = comp.process == self || comp.process.pid == spared_pid;
        if (!skipped && !runtime::isAlive(comp.process)) {
            names.emplace_back(comp.name_view());
            impl_->remove_comp(comp, true);
        }
    });
    return names;
}

void Hal::Impl::spare_process(std::int32_t pid) {
    Guard guard(*this);
    segment.header().spared_pid = pid;
}

void Hal::Impl::rest_process(std::int32_t pid) {
    Guard guard(*this);
    segment.each<PinRecord>(Kind::PIN, [&](PinRecord &pin) {
        const auto *comp = segment.at<CompRecord>(pin.comp);
        if (comp->process.pid == pid && pin.type == Type::BIT && pin.dir != Dir::IN) {
            write(value_of(pin), Value{pin.type, pin.has_safe_value ? pin.safe_value : 0});
        }
    });
}

Result<> Hal::expect_end(int comp_id) {
    Guard guard(*impl_);
    CompRecord *comp = impl_->find_comp(comp_id);
    if (comp == nullptr) {
        return refuse(EINVAL, fmt::format("there is no component with id {}", comp_id));
    }
    comp->end_requested = true;
    return {};
}

}  // namespace mw::hal
