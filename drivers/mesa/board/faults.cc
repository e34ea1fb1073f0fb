// SPDX-License-Identifier: GPL-2.0-or-later
#include "drivers/mesa/board/faults.hh"

#include <algorithm>

#include <fmt/format.h>

#include "base/text.hh"
#include "drivers/mesa/board/table_file.hh"

namespace mw::mesa::board {

namespace {

constexpr double NS_IN_US = 1e3, NS_IN_MS = 1e6;
constexpr double MAX_US = 1e9, MAX_MS = 1e9;
/// Delay of a packet that other packets overtake.
constexpr std::int64_t REORDER_NS = 700'000;

std::int64_t whole_ns(double value, double unit) {
    return static_cast<std::int64_t>(value * unit);
}

DirectionFaults read_direction(TableLine &line) {
    const auto probability = [&](std::string_view key) { return line.number(key, 0, 1, 0.0); };
    const auto delay = [&](std::string_view key) {
        return whole_ns(line.number(key, 0, MAX_US, 0.0), NS_IN_US);
    };
    DirectionFaults faults;
    faults.loss = probability("loss");
    faults.duplicate = probability("duplicate");
    faults.reorder = probability("reorder");
    faults.cut = probability("cut");
    faults.delay_ns = delay("delay_us");
    faults.jitter_ns = static_cast<double>(delay("jitter_us"));
    faults.burst = probability("burst");
    const std::int64_t least = faults.burst > 0 ? 1 : 0;
    faults.burst_packets = static_cast<unsigned>(line.whole("burst_packets", least, 1'000'000, least));
    faults.burst_delay_ns = delay("burst_delay_us");
    faults.start_ns = whole_ns(line.number("start_ms", 0, MAX_MS, 0.0), NS_IN_MS);
    return faults;
}

FaultEvent read_event(TableLine &line) {
    const std::vector<std::string> types{"reset", "power_off", "watchdog", "link_down", "second_host"};
    const auto type = std::ranges::find(types, line.name());
    if (type == types.end()) {
        line.reject("", fmt::format("'{}' is not one of {}.", line.name(), fmt::join(types, ", ")));
        return {};
    }
    FaultEvent event{.type = static_cast<FaultType>(type - types.begin())};
    event.at_ns = whole_ns(line.number("at_ms", 0, MAX_MS), NS_IN_MS);
    if (event.type != FaultType::RESET && event.type != FaultType::WATCHDOG) {
        event.duration_ns = whole_ns(line.number("duration_ms", 0, MAX_MS), NS_IN_MS);
    }
    if (event.type == FaultType::SECOND_HOST) {
        event.period_ns = whole_ns(line.number("period_us", 1, MAX_US, 1000.0), NS_IN_US);
    }
    return event;
}

}  // namespace

Result<FaultPlan> parse_faults(std::string_view text, const std::string &file) {
    auto lines = parse_table(text, file);
    if (!lines.has_value()) {
        return std::unexpected(lines.error());
    }
    FaultPlan plan;
    for (TableLine &line : *lines) {
        if (line.type() == "seed") {
            const auto seed = parse_uint(line.name());
            if (!seed.has_value()) {
                line.reject("", fmt::format("'{}' is not a seed: a whole number.", line.name()));
            }
            plan.seed = seed.value_or(0);
        } else if (line.type() == "to_board") {
            plan.to_board = read_direction(line);
        } else if (line.type() == "to_host") {
            plan.to_host = read_direction(line);
        } else if (line.type() == "event") {
            plan.events.push_back(read_event(line));
        } else {
            return fail(
                fmt::format("Unknown line '{}', expected seed, to_board, to_host or event.", line.type()),
                line.place());
        }
        if (auto finished = line.finish(); !finished.has_value()) {
            return std::unexpected(finished.error());
        }
    }
    std::ranges::stable_sort(plan.events, {}, &FaultEvent::at_ns);
    return plan;
}

FaultyDirection::FaultyDirection(const DirectionFaults &faults, std::uint64_t seed)
    : faults_(faults), random_(seed) {}

bool FaultyDirection::happens(double probability) {
    return probability > 0 && std::uniform_real_distribution<>(0, 1)(random_) < probability;
}

std::int64_t FaultyDirection::delay() {
    std::int64_t delay_ns = faults_.delay_ns;
    if (faults_.jitter_ns > 0) {
        const double jitter_ns = std::normal_distribution<>(0, faults_.jitter_ns)(random_);
        delay_ns = std::max<std::int64_t>(0, delay_ns + static_cast<std::int64_t>(jitter_ns));
    }
    if (burst_left_ == 0 && happens(faults_.burst)) {
        burst_left_ = faults_.burst_packets;
    }
    if (burst_left_ > 0) {
        --burst_left_;
        return faults_.burst_delay_ns > 0 ? delay_ns + faults_.burst_delay_ns : -1;
    }
    return delay_ns;
}

std::vector<Delivery> FaultyDirection::pass(std::vector<std::byte> bytes, std::int64_t now_ns, int host) {
    if (now_ns < faults_.start_ns) {
        return {{.time_ns = now_ns, .bytes = std::move(bytes), .host = host}};
    }
    const std::int64_t delay_ns = delay();
    if (delay_ns < 0 || happens(faults_.loss)) {
        return {};
    }
    if (!bytes.empty() && happens(faults_.cut)) {
        bytes.resize(std::uniform_int_distribution<std::size_t>(0, bytes.size() - 1)(random_));
    }
    Delivery delivery{
        .time_ns = std::max(now_ns + delay_ns, last_ns_), .bytes = std::move(bytes), .host = host};
    if (happens(faults_.reorder)) {
        delivery.time_ns += REORDER_NS;
    } else {
        last_ns_ = delivery.time_ns;
    }
    std::vector<Delivery> deliveries{delivery};
    if (happens(faults_.duplicate)) {
        deliveries.push_back(std::move(delivery));
    }
    return deliveries;
}

}  // namespace mw::mesa::board
