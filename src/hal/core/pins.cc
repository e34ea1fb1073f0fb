// SPDX-License-Identifier: GPL-2.0-or-later
#include "hal/core/pins.hh"

#include <cerrno>

#include "hal/core/detail/names.hh"
#include "hal/core/detail/records.hh"
#include "hal/core/instance.hh"

namespace mw::hal {

using namespace detail;

namespace {

PinInfo info_of(const Segment &segment, const PinRecord &pin) {
    PinInfo info;
    describe(segment, pin, info);
    if (const auto *signal = segment.at<SignalRecord>(pin.signal)) {
        info.signal = signal->name_view();
    }
    info.value = value_at(segment, pin.type, value_of(segment, pin));
    return info;
}

}  // namespace

Result<> Pins::create(std::string_view name, Type type, Dir dir, void **slot, int comp_id) {
    Guard guard(segment_);
    auto comp = comp_for_new(segment_, comp_id, name, "pin");
    if (!comp) {
        return std::unexpected(comp.error());
    }
    return add_pin(segment_, **comp, {name, type, dir, slot});
}

Result<void **> Pins::create(std::string_view name, Type type, Dir dir, int comp_id) {
    void **slot = nullptr;
    {
        Guard guard(segment_);
        slot = segment_.at<void *>(segment_.allocate(sizeof(void *)));
    }
    if (slot == nullptr) {
        return refuse(ENOMEM, fmt::format("pin '{}': no HAL memory left", name));
    }
    if (auto made = create(name, type, dir, slot, comp_id); !made) {
        return std::unexpected(made.error());
    }
    return slot;
}

Result<> Pins::set_safe_value(std::string_view name, const Value &value) {
    Guard guard(segment_);
    PinRecord *pin = find_pin(segment_, name);
    if (pin == nullptr) {
        return no_such(segment_, Kind::PIN, name);
    }
    if (pin->type != value.type) {
        return refuse(EINVAL, fmt::format("pin '{}' is of type {}, its safe value of type {}", name,
                                          type_name(pin->type), type_name(value.type)));
    }
    pin->safe_value = value.bits;
    pin->has_safe_value = true;
    return {};
}

Result<> Pins::set_alias(std::string_view name, std::string_view alias) {
    Guard guard(segment_);
    if (auto checked = check_lock(segment_, LOCK_CONFIG, "aliases"); !checked) {
        return checked;
    }
    PinRecord *pin = find_pin(segment_, name);
    if (pin == nullptr) {
        return no_such(segment_, Kind::PIN, name);
    }
    return detail::set_alias(segment_, Kind::PIN, Kind::PIN_ALIAS, *pin, alias);
}

std::vector<PinInfo> Pins::list(std::string_view glob) const {
    std::vector<PinInfo> list;
    {
        Guard guard(segment_);
        segment_.each<PinRecord>(Kind::PIN, [&](PinRecord &pin) {
            PinInfo info = info_of(segment_, pin);
            if (isListed(glob, info)) {
                list.push_back(std::move(info));
            }
        });
    }
    sort_by_name(list);
    return list;
}

bool Pins::has(std::string_view name) const {
    Guard guard(segment_);
    return find_pin(segment_, name) != nullptr;
}

Result<PinInfo> Pins::find(std::string_view name) const {
    Guard guard(segment_);
    const PinRecord *pin = find_pin(segment_, name);
    if (pin == nullptr) {
        return no_such(segment_, Kind::PIN, name);
    }
    return info_of(segment_, *pin);
}

Result<Value> Pins::get(std::string_view name) const {
    Guard guard(segment_);
    const PinRecord *pin = find_pin(segment_, name);
    if (pin == nullptr) {
        return no_such(segment_, Kind::PIN, name);
    }
    return value_at(segment_, pin->type, value_of(segment_, *pin));
}

const std::atomic<std::uint32_t> &Pins::link_changes() const noexcept {
    return segment_.header().links;
}

}  // namespace mw::hal
