// SPDX-License-Identifier: GPL-2.0-or-later
#include "hal/core/detail/records.hh"

#include <cerrno>
#include <string>

#include "hal/core/detail/function_lists.hh"
#include "hal/core/detail/names.hh"
#include "hal/core/instance.hh"

namespace mw::hal::detail {
namespace {

template <class T>
T *find_named(const Segment &segment, Kind kind, Kind alias_kind, std::string_view name) noexcept {
    if (auto *record = segment.find_as<T>(kind, name)) {
        return record;
    }
    const auto *alias = segment.find_as<AliasRecord>(alias_kind, name);
    return alias == nullptr ? nullptr : segment.at<T>(alias->target);
}

bool isType(Type type) noexcept {
    return type >= Type::BIT && type <= Type::U64;
}

/// One aligned store into the owner's mapping: the component sees either the old or the new address.
void point_slot(const Segment &segment, const PinRecord &pin, Offset value) noexcept {
    const auto *comp = segment.at<CompRecord>(pin.comp);
    // Release: a thread that follows the new address sees the value stored there before.
    __atomic_store_n(segment.at<std::uint64_t>(pin.slot), comp->base + value, __ATOMIC_RELEASE);
    // Release: a thread that sees the count writes to the new address.
    segment.header().links.fetch_add(1, std::memory_order_release);
}

template <class T>
void remove_named(Segment &segment, Kind kind, Kind alias_kind, T &record) noexcept {
    if (auto *alias = segment.at<AliasRecord>(record.alias)) {
        segment.remove(alias_kind, *alias);
    }
    segment.remove(kind, record);
}

}  // namespace

CompRecord *find_comp(const Segment &segment, int comp_id) noexcept {
    CompRecord *found = nullptr;
    segment.each<CompRecord>(Kind::COMP, [&](CompRecord &comp) {
        if (comp.id == comp_id) {
            found = &comp;
        }
    });
    return found;
}

PinRecord *find_pin(const Segment &segment, std::string_view name) noexcept {
    return find_named<PinRecord>(segment, Kind::PIN, Kind::PIN_ALIAS, name);
}

ParamRecord *find_param(const Segment &segment, std::string_view name) noexcept {
    return find_named<ParamRecord>(segment, Kind::PARAM, Kind::PARAM_ALIAS, name);
}

Result<int> add_comp(Segment &segment, std::string_view name, CompType type) {
    if (auto checked = check_name(segment, Kind::COMP, name); !checked) {
        return std::unexpected(checked.error());
    }
    auto *comp = segment.make<CompRecord>(Kind::COMP, name);
    if (comp == nullptr) {
        return refuse(ENOMEM, fmt::format("component '{}': no HAL memory left", name));
    }
    comp->id = segment.header().next_comp_id;
    segment.header().next_comp_id += 3;
    comp->type = type;
    comp->process = runtime::this_process();
    comp->base = segment.base();
    segment.insert(Kind::COMP, *comp);
    // Writes of other processes and threads must not share a cache line with this one.
    segment.separate_values();
    return comp->id;
}

Result<CompRecord *> comp_for_new(const Segment &segment, int comp_id, std::string_view name,
                                  const char *what) {
    CompRecord *comp = find_comp(segment, comp_id);
    if (comp == nullptr) {
        return refuse(EINVAL, fmt::format("{} '{}': there is no component with id {}", what, name, comp_id));
    }
    if (comp->isReady) {
        return refuse(EINVAL, fmt::format("{} '{}': component '{}' is ready, nothing can be added", what,
                                          name, comp->name_view()));
    }
    if (comp->base != segment.base()) {
        return refuse(EINVAL, fmt::format("{} '{}': component '{}' belongs to another process", what, name,
                                          comp->name_view()));
    }
    if (auto checked = check_lock(segment, LOCK_LOAD, "new pins, parameters and functions"); !checked) {
        return std::unexpected(checked.error());
    }
    return comp;
}

Result<> add_pin(Segment &segment, CompRecord &comp, const PinDeclaration &declared) {
    const auto &[name, type, dir, slot] = declared;
    if (auto checked = check_name(segment, Kind::PIN, name); !checked) {
        return checked;
    }
    if (!isType(type) || (dir != Dir::IN && dir != Dir::OUT && dir != Dir::IO)) {
        return refuse(EINVAL, fmt::format("pin '{}': type {} or direction {} is not valid for a pin", name,
                                          static_cast<int>(type), static_cast<int>(dir)));
    }
    if (!segment.contains(slot, sizeof *slot) || reinterpret_cast<std::uintptr_t>(slot) % sizeof *slot != 0) {
        return refuse(EINVAL, fmt::format("pin '{}': its pointer is not allocated by hal_malloc", name));
    }
    auto *pin = segment.make<PinRecord>(Kind::PIN, name);
    if (pin == nullptr) {
        return refuse(ENOMEM, fmt::format("pin '{}': no HAL memory left", name));
    }
    pin->type = type;
    pin->dir = dir;
    pin->comp = segment.offset_of(&comp);
    pin->slot = segment.offset_of(slot);
    point_slot(segment, *pin, pin->value);
    segment.insert(Kind::PIN, *pin);
    return {};
}

Result<> add_param(Segment &segment, CompRecord &comp, const ParamDeclaration &declared) {
    const auto &[name, type, dir, address] = declared;
    if (auto checked = check_name(segment, Kind::PARAM, name); !checked) {
        return checked;
    }
    if (!isType(type) || type == Type::PORT || (dir != Dir::RO && dir != Dir::RW)) {
        return refuse(EINVAL,
                      fmt::format("parameter '{}': type {} or direction {} is not valid for a parameter",
                                  name, static_cast<int>(type), static_cast<int>(dir)));
    }
    if (!segment.contains(address, type == Type::BIT ? 1 : 4)) {
        return refuse(EINVAL, fmt::format("parameter '{}': its value is not allocated by hal_malloc", name));
    }
    auto *param = segment.make<ParamRecord>(Kind::PARAM, name);
    if (param == nullptr) {
        return refuse(ENOMEM, fmt::format("parameter '{}': no HAL memory left", name));
    }
    param->type = type;
    param->dir = dir;
    param->comp = segment.offset_of(&comp);
    param->address = segment.offset_of(address);
    segment.insert(Kind::PARAM, *param);
    return {};
}

void remove_comp(Segment &segment, CompRecord &comp, Outputs outputs) noexcept {
    const Offset owner = segment.offset_of(&comp);
    segment.each<FunctRecord>(Kind::FUNCT, [&](FunctRecord &funct) {
        if (funct.comp == owner) {
            drop_from_lists(segment, segment.offset_of(&funct));
            segment.remove(Kind::FUNCT, funct);
        }
    });
    segment.each<PinRecord>(Kind::PIN, [&](PinRecord &pin) {
        if (pin.comp == owner) {
            if (outputs == Outputs::SAFE && pin.dir != Dir::IN) {
                set_safe_value(segment, pin);
            }
            unlink_pin(segment, pin);
            remove_named(segment, Kind::PIN, Kind::PIN_ALIAS, pin);
        }
    });
    segment.each<ParamRecord>(Kind::PARAM, [&](ParamRecord &param) {
        if (param.comp == owner) {
            remove_named(segment, Kind::PARAM, Kind::PARAM_ALIAS, param);
        }
    });
    segment.remove(Kind::COMP, comp);
}

Offset value_of(const Segment &segment, const PinRecord &pin) noexcept {
    const auto *signal = segment.at<SignalRecord>(pin.signal);
    return signal != nullptr ? signal->value : pin.value;
}

Value value_at(const Segment &segment, Type type, Offset value) noexcept {
    return load_value(type, segment.at<void>(value));
}

void set_safe_value(const Segment &segment, const PinRecord &pin) noexcept {
    store_value(segment.at<void>(value_of(segment, pin)),
                Value{pin.type, pin.has_safe_value ? pin.safe_value : 0});
}

std::int32_t &count_of(SignalRecord &signal, Dir dir) noexcept {
    return dir == Dir::IN ? signal.readers : dir == Dir::OUT ? signal.writers : signal.bidirectionals;
}

void link_pin(Segment &segment, PinRecord &pin, SignalRecord &signal) noexcept {
    if (pin.signal == segment.offset_of(&signal)) {
        return;
    }
    // The queue of a port belongs to the signal.
    if (signal.type != Type::PORT && signal.readers + signal.writers + signal.bidirectionals == 0) {
        store_value(segment.at<void>(signal.value), value_at(segment, pin.type, pin.value));
    }
    pin.signal = segment.offset_of(&signal);
    ++count_of(signal, pin.dir);
    point_slot(segment, pin, signal.value);
}

void unlink_pin(Segment &segment, PinRecord &pin) noexcept {
    auto *signal = segment.at<SignalRecord>(pin.signal);
    if (signal == nullptr) {
        return;
    }
    if (signal->type != Type::PORT) {
        store_value(segment.at<void>(pin.value), value_at(segment, pin.type, signal->value));
    }
    pin.signal = 0;
    --count_of(*signal, pin.dir);
    point_slot(segment, pin, pin.value);
}

}  // namespace mw::hal::detail
