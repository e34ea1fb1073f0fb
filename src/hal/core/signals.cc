// SPDX-License-Identifier: GPL-2.0-or-later
#include "hal/core/signals.hh"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <utility>

#include "hal/core/detail/names.hh"
#include "hal/core/detail/records.hh"
#include "hal/core/detail/typed_values.hh"
#include "hal/core/instance.hh"
#include "hal/core/port_queue.hh"
#include "hal/include/hal.h"

namespace mw::hal {

using namespace detail;

namespace {

SignalRecord *find_signal(const Segment &segment, std::string_view name) noexcept {
    return segment.find_as<SignalRecord>(Kind::SIGNAL, name);
}

/// Name of a pin that writes the signal, for messages; a pin that is not linked yet is not found.
std::string writer_of(const Segment &segment, const SignalRecord &signal) {
    std::string text = "another pin of the same net";
    const SignalRecord *real = find_signal(segment, signal.name_view());
    const Offset offset = real == nullptr ? 0 : segment.offset_of(real);
    segment.each<PinRecord>(Kind::PIN, [&](PinRecord &pin) {
        if (offset != 0 && pin.signal == offset && pin.dir != Dir::IN) {
            text = fmt::format("pin '{}'", pin.name_view());
        }
    });
    return text;
}

Result<SignalRecord *> make_signal(Segment &segment, std::string_view name, Type type) {
    if (auto checked = check_name(segment, Kind::SIGNAL, name); !checked) {
        return std::unexpected(checked.error());
    }
    auto *signal = segment.make<SignalRecord>(Kind::SIGNAL, name);
    if (signal == nullptr) {
        return refuse(ENOMEM, fmt::format("signal '{}': no HAL memory left", name));
    }
    signal->type = type;
    segment.insert(Kind::SIGNAL, *signal);
    return signal;
}

Result<> make_queue(Segment &segment, SignalRecord &signal, std::uint32_t size) {
    auto *queue = segment.at<std::uint64_t>(signal.value);
    if (*queue != 0) {
        return refuse(EBUSY, fmt::format("port signal '{}' has its size already", signal.name_view()));
    }
    if (size < 2 || size > HAL_PORT_SIZE_MAX) {
        return refuse(EINVAL, fmt::format("port signal '{}': a size of {} is outside of 2 to {}",
                                          signal.name_view(), size, HAL_PORT_SIZE_MAX));
    }
    const Offset offset = segment.allocate(sizeof(PortQueue) + size);
    if (offset == 0) {
        return refuse(ENOMEM, fmt::format("port signal '{}': no HAL memory left", signal.name_view()));
    }
    segment.at<PortQueue>(offset)->size = size;
    // Release: a process that sees the queue sees its size.
    __atomic_store_n(queue, std::uint64_t{offset}, __ATOMIC_RELEASE);
    return {};
}

template <class From>
Result<> set_signal_value(Segment &segment, std::string_view name, const From &from) {
    if (auto checked = check_lock(segment, LOCK_PARAMS, "setting signals"); !checked) {
        return checked;
    }
    SignalRecord *signal = find_signal(segment, name);
    if (signal == nullptr) {
        return no_such(segment, Kind::SIGNAL, name);
    }
    if (signal->type == Type::PORT) {
        const auto size = in_type(Type::PORT, name, from);
        return size ? make_queue(segment, *signal, size->as_u32()) : Result<>(std::unexpected(size.error()));
    }
    if (signal->writers > 0) {
        return refuse(EPERM, fmt::format("signal '{}' is written by {}", name, writer_of(segment, *signal)));
    }
    const auto value = in_type(signal->type, name, from);
    if (!value) {
        return std::unexpected(value.error());
    }
    store_value(segment.at<void>(signal->value), *value);
    return {};
}

Result<> check_link(const Segment &segment, const PinRecord &pin, const SignalRecord &signal) {
    const auto *linked = segment.at<SignalRecord>(pin.signal);
    if (linked == &signal) {
        return {};
    }
    if (linked != nullptr) {
        return refuse(EINVAL, fmt::format("pin '{}' is linked to signal '{}' already", pin.name_view(),
                                          linked->name_view()));
    }
    if (pin.type != signal.type) {
        return refuse(EINVAL, fmt::format("pin '{}' is of type {}, signal '{}' of type {}", pin.name_view(),
                                          type_name(pin.type), signal.name_view(), type_name(signal.type)));
    }
    const bool taken = (pin.dir == Dir::OUT && signal.writers + signal.bidirectionals > 0) ||
                       (pin.dir == Dir::IO && signal.writers > 0);
    if (taken) {
        return refuse(EINVAL, fmt::format("signal '{}' cannot have {} pin '{}': {} writes it already",
                                          signal.name_view(), dir_name(pin.dir), pin.name_view(),
                                          writer_of(segment, signal)));
    }
    return {};
}

SignalInfo info_of(const Segment &segment, const SignalRecord &signal) {
    SignalInfo info;
    info.name = signal.name_view();
    info.type = signal.type;
    info.value = value_at(segment, signal.type, signal.value);
    info.readers = signal.readers;
    info.writers = signal.writers;
    info.bidirectionals = signal.bidirectionals;
    return info;
}

}  // namespace

Result<> Signals::create(std::string_view name, Type type) {
    Guard guard(segment_);
    if (auto checked = check_lock(segment_, LOCK_CONFIG, "new signals"); !checked) {
        return checked;
    }
    auto made = make_signal(segment_, name, type);
    return made ? Result<>{} : std::unexpected(made.error());
}

Result<> Signals::remove(std::string_view name) {
    Guard guard(segment_);
    if (auto checked = check_lock(segment_, LOCK_CONFIG, "removing signals"); !checked) {
        return checked;
    }
    SignalRecord *signal = find_signal(segment_, name);
    if (signal == nullptr) {
        return no_such(segment_, Kind::SIGNAL, name);
    }
    const Offset offset = segment_.offset_of(signal);
    segment_.each<PinRecord>(Kind::PIN, [&](PinRecord &pin) {
        if (pin.signal == offset) {
            unlink_pin(segment_, pin);
        }
    });
    segment_.remove(Kind::SIGNAL, *signal);
    return {};
}

Result<> Signals::link(std::string_view pin_name, std::string_view signal_name) {
    Guard guard(segment_);
    if (auto checked = check_lock(segment_, LOCK_CONFIG, "links"); !checked) {
        return checked;
    }
    PinRecord *pin = find_pin(segment_, pin_name);
    if (pin == nullptr) {
        return no_such(segment_, Kind::PIN, pin_name);
    }
    SignalRecord *signal = find_signal(segment_, signal_name);
    if (signal == nullptr) {
        return no_such(segment_, Kind::SIGNAL, signal_name);
    }
    if (auto checked = check_link(segment_, *pin, *signal); !checked) {
        return checked;
    }
    link_pin(segment_, *pin, *signal);
    return {};
}

Result<> Signals::unlink(std::string_view name) {
    Guard guard(segment_);
    if (auto checked = check_lock(segment_, LOCK_CONFIG, "links"); !checked) {
        return checked;
    }
    PinRecord *pin = find_pin(segment_, name);
    if (pin == nullptr) {
        return no_such(segment_, Kind::PIN, name);
    }
    unlink_pin(segment_, *pin);
    return {};
}

Result<> Signals::net(std::string_view signal_name, const std::vector<std::string> &pins) {
    Guard guard(segment_);
    if (auto checked = check_lock(segment_, LOCK_CONFIG, "links"); !checked) {
        return checked;
    }
    std::vector<PinRecord *> records;
    for (const std::string &name : pins) {
        records.push_back(find_pin(segment_, name));
        if (records.back() == nullptr) {
            return no_such(segment_, Kind::PIN, name);
        }
    }
    SignalRecord *signal = find_signal(segment_, signal_name);
    if (signal == nullptr && records.empty()) {
        return no_such(segment_, Kind::SIGNAL, signal_name);
    }
    if (signal == nullptr && find_pin(segment_, signal_name) != nullptr) {
        return refuse(EINVAL, fmt::format("'{}' is the name of a pin", signal_name),
                      "the first word after net is the signal's name");
    }
    // Links a copy first, so that nothing changes unless all pins can be linked.
    SignalRecord trial{};
    if (signal != nullptr) {
        trial.type = signal->type;
        trial.readers = signal->readers;
        trial.writers = signal->writers;
        trial.bidirectionals = signal->bidirectionals;
    } else {
        trial.type = records.front()->type;
        if (auto checked = check_name(segment_, Kind::SIGNAL, signal_name); !checked) {
            return checked;
        }
    }
    std::memcpy(trial.name.data(), signal_name.data(), std::min(signal_name.size(), NAME_LENGTH));
    for (auto at = records.begin(); at != records.end(); ++at) {
        PinRecord *pin = *at;
        const bool is_linked = signal != nullptr && pin->signal == segment_.offset_of(signal);
        if (is_linked || std::find(records.begin(), at, pin) != at) {
            continue;
        }
        if (auto checked = check_link(segment_, *pin, trial); !checked) {
            return checked;
        }
        ++count_of(trial, pin->dir);
    }
    if (signal == nullptr) {
        auto made = make_signal(segment_, signal_name, trial.type);
        if (!made) {
            return std::unexpected(made.error());
        }
        signal = *made;
    }
    for (PinRecord *pin : records) {
        link_pin(segment_, *pin, *signal);
    }
    return {};
}

std::vector<SignalInfo> Signals::list(std::string_view glob) const {
    std::vector<SignalInfo> list;
    std::vector<std::pair<std::string, SignalPin>> linked;
    {
        Guard guard(segment_);
        segment_.each<SignalRecord>(Kind::SIGNAL, [&](SignalRecord &signal) {
            if (isMatch(glob, std::string(signal.name_view()))) {
                list.push_back(info_of(segment_, signal));
            }
        });
        segment_.each<PinRecord>(Kind::PIN, [&](PinRecord &pin) {
            if (const auto *signal = segment_.at<SignalRecord>(pin.signal)) {
                linked.emplace_back(signal->name_view(),
                                    SignalPin{shown_name(segment_, pin, pin.alias), pin.dir});
            }
        });
    }
    sort_by_name(list);
    std::sort(linked.begin(), linked.end(), [](const auto &a, const auto &b) {
        return a.first != b.first ? a.first < b.first : a.second.name < b.second.name;
    });
    for (SignalInfo &info : list) {
        auto at =
            std::lower_bound(linked.begin(), linked.end(), info.name,
                             [](const auto &entry, const std::string &name) { return entry.first < name; });
        for (; at != linked.end() && at->first == info.name; ++at) {
            info.pins.push_back(at->second);
        }
    }
    return list;
}

bool Signals::has(std::string_view name) const {
    Guard guard(segment_);
    return find_signal(segment_, name) != nullptr;
}

Result<SignalInfo> Signals::find(std::string_view name) const {
    Guard guard(segment_);
    const SignalRecord *signal = find_signal(segment_, name);
    if (signal == nullptr) {
        return no_such(segment_, Kind::SIGNAL, name);
    }
    SignalInfo info = info_of(segment_, *signal);
    const Offset offset = segment_.offset_of(signal);
    segment_.each<PinRecord>(Kind::PIN, [&](PinRecord &pin) {
        if (pin.signal == offset) {
            info.pins.push_back({shown_name(segment_, pin, pin.alias), pin.dir});
        }
    });
    sort_by_name(info.pins);
    return info;
}

Result<Value> Signals::get(std::string_view name) const {
    Guard guard(segment_);
    const SignalRecord *signal = find_signal(segment_, name);
    if (signal == nullptr) {
        return no_such(segment_, Kind::SIGNAL, name);
    }
    return value_at(segment_, signal->type, signal->value);
}

Result<> Signals::set(std::string_view name, const Value &value) {
    Guard guard(segment_);
    return set_signal_value(segment_, name, value);
}

Result<> Signals::set(std::string_view name, std::string_view text) {
    Guard guard(segment_);
    return set_signal_value(segment_, name, text);
}

}  // namespace mw::hal
