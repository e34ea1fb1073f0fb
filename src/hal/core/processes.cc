// SPDX-License-Identifier: GPL-2.0-or-later
#include "hal/core/processes.hh"

#include <time.h>

#include <algorithm>
#include <cerrno>

#include "hal/core/controller_watches.hh"
#include "hal/core/detail/names.hh"
#include "hal/core/detail/records.hh"

namespace mw::hal {

using namespace detail;

namespace {

void note_death(const Segment &segment, const CompRecord &comp) noexcept {
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

}  // namespace

std::vector<runtime::ProcessId> Processes::others() const {
    Guard guard(segment_);
    std::vector<runtime::ProcessId> others;
    const runtime::ProcessId self = runtime::this_process();
    segment_.each<CompRecord>(Kind::COMP, [&](const CompRecord &comp) {
        if (comp.process != self && std::ranges::find(others, comp.process) == others.end()) {
            others.push_back(comp.process);
        }
    });
    return others;
}

std::vector<std::string> Processes::reap_dead() {
    Guard guard(segment_);
    std::vector<std::string> names;
    const runtime::ProcessId self = runtime::this_process();
    const std::int32_t spared_pid = segment_.header().spared_pid;
    segment_.each<CompRecord>(Kind::COMP, [&](CompRecord &comp) {
        const bool skipped = comp.process == self || comp.process.pid == spared_pid;
        if (!skipped && !runtime::isAlive(comp.process)) {
            names.emplace_back(comp.name_view());
            note_death(segment_, comp);
            watches_.remove(comp.id);
            remove_comp(segment_, comp, Outputs::SAFE);
        }
    });
    return names;
}

Result<> Processes::expect_end(int comp_id) {
    Guard guard(segment_);
    CompRecord *comp = find_comp(segment_, comp_id);
    if (comp == nullptr) {
        return refuse(EINVAL, fmt::format("there is no component with id {}", comp_id));
    }
    comp->end_requested = true;
    return {};
}

std::vector<DeathInfo> Processes::deaths() const {
    Guard guard(segment_);
    const Header &header = segment_.header();
    std::vector<DeathInfo> deaths;
    const std::uint32_t kept = std::min<std::uint32_t>(header.death_count, DEATHS);
    for (std::uint32_t i = header.death_count - kept; i != header.death_count; ++i) {
        const DeathRecord &death = header.deaths[i % DEATHS];
        const std::string name = death.name.data();
        // Only the last death of a component is kept, and none of a component that was restarted.
        std::erase_if(deaths, [&](const DeathInfo &earlier) { return earlier.name == name; });
        if (segment_.find(Kind::COMP, name) == nullptr) {
            deaths.push_back({name, death.pid, death.time_ns});
        }
    }
    return deaths;
}

void Processes::spare(std::int32_t pid) {
    Guard guard(segment_);
    segment_.header().spared_pid = pid;
}

void Processes::set_safe_outputs(std::int32_t pid) {
    Guard guard(segment_);
    segment_.each<PinRecord>(Kind::PIN, [&](PinRecord &pin) {
        const auto *comp = segment_.at<CompRecord>(pin.comp);
        if (comp->process.pid == pid && pin.type == Type::BIT && pin.dir != Dir::IN) {
            set_safe_value(segment_, pin);
        }
    });
}

}  // namespace mw::hal
