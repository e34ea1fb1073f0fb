// SPDX-License-Identifier: GPL-2.0-or-later
#include "hal/core/values.hh"

#include <cerrno>

#include "hal/core/detail/names.hh"
#include "hal/core/detail/records.hh"
#include "hal/core/detail/typed_values.hh"
#include "hal/core/instance.hh"

namespace mw::hal {

using namespace detail;

namespace {

template <class From>
Result<> set_pin_or_param(Segment &segment, std::string_view name, const From &from) {
    if (auto checked = check_lock(segment, LOCK_PARAMS, "setting parameters and pins"); !checked) {
        return checked;
    }
    if (const ParamRecord *param = find_param(segment, name)) {
        if (param->dir != Dir::RW) {
            return refuse(EPERM, fmt::format("parameter '{}' is read-only", name));
        }
        const auto value = in_type(param->type, name, from);
        if (!value) {
            return std::unexpected(value.error());
        }
        store_value(segment.at<void>(param->address), *value);
        return {};
    }
    PinRecord *pin = find_pin(segment, name);
    if (pin == nullptr) {
        return no_such_value(segment, name);
    }
    if (pin->dir == Dir::OUT) {
        return refuse(EPERM, fmt::format("pin '{}' is an output, its component sets it", name));
    }
    if (pin->signal != 0) {
        return refuse(EPERM,
                      fmt::format("pin '{}' is linked to signal '{}'", name,
                                  segment.at<SignalRecord>(pin->signal)->name_view()),
                      "set the signal instead");
    }
    const auto value = in_type(pin->type, name, from);
    if (!value) {
        return std::unexpected(value.error());
    }
    store_value(segment.at<void>(value_of(segment, *pin)), *value);
    return {};
}

}  // namespace

Result<Value> Values::get(std::string_view name) const {
    Guard guard(segment_);
    if (const ParamRecord *param = find_param(segment_, name)) {
        return value_at(segment_, param->type, param->address);
    }
    if (const PinRecord *pin = find_pin(segment_, name)) {
        return value_at(segment_, pin->type, value_of(segment_, *pin));
    }
    return no_such_value(segment_, name);
}

Result<> Values::set(std::string_view name, const Value &value) {
    Guard guard(segment_);
    return set_pin_or_param(segment_, name, value);
}

Result<> Values::set(std::string_view name, std::string_view text) {
    Guard guard(segment_);
    return set_pin_or_param(segment_, name, text);
}

Result<> Values::force(std::string_view pin_or_signal, const Value &value) {
    auto address = address_of(pin_or_signal, value.type);
    if (!address) {
        return std::unexpected(address.error());
    }
    Guard guard(segment_);
    store_value(const_cast<void *>(*address), value);
    return {};
}

Result<volatile void *> Values::address_of(std::string_view name, Type type) {
    Guard guard(segment_);
    Type found = type;
    Offset value = 0;
    if (const ParamRecord *param = find_param(segment_, name)) {
        found = param->type;
        value = param->address;
    } else if (const PinRecord *pin = find_pin(segment_, name)) {
        found = pin->type;
        value = value_of(segment_, *pin);
    } else if (const auto *signal = segment_.find_as<SignalRecord>(Kind::SIGNAL, name)) {
        found = signal->type;
        value = signal->value;
    } else {
        return no_such(segment_, Kind::PIN, name);
    }
    if (found != type) {
        return refuse(EINVAL,
                      fmt::format("'{}' is of type {}, not {}", name, type_name(found), type_name(type)));
    }
    return segment_.at<void>(value);
}

}  // namespace mw::hal
