// SPDX-License-Identifier: GPL-2.0-or-later
// Pins, parameters, functions and aliases.
#include <cerrno>
#include <cstring>

#include "hal/core/detail/impl.hh"

namespace mw::hal {

using namespace detail;

PinRecord *Hal::Impl::find_pin(std::string_view wanted) const noexcept {
    if (auto *pin = segment.find_as<PinRecord>(Kind::PIN, wanted)) {
        return pin;
    }
    const auto *alias = segment.find_as<AliasRecord>(Kind::PIN_ALIAS, wanted);
    return alias == nullptr ? nullptr : segment.at<PinRecord>(alias->target);
}

ParamRecord *Hal::Impl::find_param(std::string_view wanted) const noexcept {
    if (auto *param = segment.find_as<ParamRecord>(Kind::PARAM, wanted)) {
        return param;
    }
    const auto *alias = segment.find_as<AliasRecord>(Kind::PARAM_ALIAS, wanted);
    return alias == nullptr ? nullptr : segment.at<ParamRecord>(alias->target);
}

Offset Hal::Impl::value_of(const PinRecord &pin) const noexcept {
    const auto *signal = segment.at<SignalRecord>(pin.signal);
    return signal != nullptr ? signal->value : pin.value;
}

/// One aligned store into the owner's mapping: the component sees either the old or the new address.
void Hal::Impl::point_slot(const PinRecord &pin, Offset value) noexcept {
    const auto *comp = segment.at<CompRecord>(pin.comp);
    // Release: a thread that follows the new address sees the value stored there before.
    __atomic_store_n(segment.at<std::uint64_t>(pin.slot), comp->base + value, __ATOMIC_RELEASE);
    // Release: a thread that sees the count writes to the new address.
    segment.header().links.fetch_add(1, std::memory_order_release);
}

namespace {

/// Only the process that owns the component may create pins and parameters: their addresses are in its
/// memory.
Result<CompRecord *> comp_for_new(Hal::Impl &hal, int comp_id, std::string_view name, const char *what) {
    CompRecord *comp = hal.find_comp(comp_id);
    if (comp == nullptr) {
        return refuse(EINVAL, fmt::format("{} '{}': there is no component with id {}", what, name, comp_id));
    }
    if (comp->isReady) {
        return refuse(EINVAL, fmt::format("{} '{}': component '{}' is ready, nothing can be added", what,
                                          name, comp->name_view()));
    }
    if (comp->base != hal.segment.base()) {
        return refuse(EINVAL, fmt::format("{} '{}': component '{}' belongs to another process", what, name,
                                          comp->name_view()));
    }
    if (auto checked = hal.check_lock(LOCK_LOAD, "new pins, parameters and functions"); !checked) {
        return std::unexpected(checked.error());
    }
    return comp;
}

bool isType(Type type) noexcept {
    return type >= Type::BIT && type <= Type::U64;
}

}  // namespace

Result<> Hal::Impl::add_pin(std::string_view wanted, Type type, Dir dir, void **slot, CompRecord &comp) {
    if (auto checked = check_name(Kind::PIN, wanted); !checked) {
        return checked;
    }
    if (!isType(type) || (dir != Dir::IN && dir != Dir::OUT && dir != Dir::IO)) {
        return refuse(EINVAL, fmt::format("pin '{}': type {} or direction {} is not valid for a pin", wanted,
                                          static_cast<int>(type), static_cast<int>(dir)));
    }
    if (!segment.contains(slot, sizeof *slot) || reinterpret_cast<std::uintptr_t>(slot) % sizeof *slot != 0) {
        return refuse(EINVAL, fmt::format("pin '{}': its pointer is not in memory of hal_malloc", wanted));
    }
    auto *pin = segment.make<PinRecord>(Kind::PIN, wanted);
    if (pin == nullptr) {
        return refuse(ENOMEM, fmt::format("pin '{}': no HAL memory left", wanted));
    }
    pin->type = type;
    pin->dir = dir;
    pin->comp = segment.offset_of(&comp);
    pin->slot = segment.offset_of(slot);
    point_slot(*pin, pin->value);
    segment.insert(Kind::PIN, *pin);
    return {};
}

Result<> Hal::new_pin(std::string_view name, Type type, Dir dir, void **slot, int comp_id) {
    Guard guard(*impl_);
    auto comp = comp_for_new(*impl_, comp_id, name, "pin");
    if (!comp) {
        return std::unexpected(comp.error());
    }
    return impl_->add_pin(name, type, dir, slot, **comp);
}

Result<void **> Hal::new_pin(std::string_view name, Type type, Dir dir, int comp_id) {
    auto **slot = static_cast<void **>(allocate(sizeof(void *)));
    if (slot == nullptr) {
        return refuse(ENOMEM, fmt::format("pin '{}': no HAL memory left", name));
    }
    if (auto made = new_pin(name, type, dir, slot, comp_id); !made) {
        return std::unexpected(made.error());
    }
    return slot;
}

Result<> Hal::Impl::add_param(std::string_view wanted, Type type, Dir dir, void *address, CompRecord &comp) {
    if (auto checked = check_name(Kind::PARAM, wanted); !checked) {
        return checked;
    }
    if (!isType(type) || type == Type::PORT || (dir != Dir::RO && dir != Dir::RW)) {
        return refuse(EINVAL,
                      fmt::format("parameter '{}': type {} or direction {} is not valid for a parameter",
                                  wanted, static_cast<int>(type), static_cast<int>(dir)));
    }
    if (!segment.contains(address, type == Type::BIT ? 1 : 4)) {
        return refuse(EINVAL,
                      fmt::format("parameter '{}': its value is not in memory of hal_malloc", wanted));
    }
    auto *param = segment.make<ParamRecord>(Kind::PARAM, wanted);
    if (param == nullptr) {
        return refuse(ENOMEM, fmt::format("parameter '{}': no HAL memory left", wanted));
    }
    param->type = type;
    param->dir = dir;
    param->comp = segment.offset_of(&comp);
    param->address = segment.offset_of(address);
    segment.insert(Kind::PARAM, *param);
    return {};
}

Result<> Hal::new_param(std::string_view name, Type type, Dir dir, void *address, int comp_id) {
    Guard guard(*impl_);
    auto comp = comp_for_new(*impl_, comp_id, name, "parameter");
    if (!comp) {
        return std::unexpected(comp.error());
    }
    return impl_->add_param(name, type, dir, address, **comp);
}

Result<> Hal::new_funct(std::string_view name, void (*function)(void *, long), void *argument, int comp_id,
                        bool reentrant, bool usesFloat) {
    Guard guard(*impl_);
    auto comp = comp_for_new(*impl_, comp_id, name, "function");
    if (!comp) {
        return std::unexpected(comp.error());
    }
    if (auto checked = impl_->check_name(Kind::FUNCT, name); !checked) {
        return checked;
    }
    if ((*comp)->type != CompType::REALTIME || function == nullptr) {
        return refuse(EINVAL, fmt::format("function '{}': only realtime components have functions", name));
    }
    Segment &segment = impl_->segment;
    auto *funct = segment.make<FunctRecord>(Kind::FUNCT, name);
    if (funct == nullptr) {
        return refuse(ENOMEM, fmt::format("function '{}': no HAL memory left", name));
    }
    funct->comp = segment.offset_of(*comp);
    funct->reentrant = reentrant;
    funct->usesFloat = usesFloat;
    funct->function = reinterpret_cast<std::uint64_t>(function);
    funct->argument = reinterpret_cast<std::uint64_t>(argument);
    segment.insert(Kind::FUNCT, *funct);
    // Names too long for the three pins are an error too; pins created so far are removed with the component.
    const std::string prefix(name);
    auto made = impl_->add_pin(prefix + ".time", Type::S32, Dir::OUT,
                               reinterpret_cast<void **>(&funct->time_slot), **comp);
    if (made) {
        made = impl_->add_param(prefix + ".tmax", Type::S32, Dir::RW, &funct->tmax, **comp);
    }
    if (made) {
        made =
            impl_->add_param(prefix + ".tmax-increased", Type::BIT, Dir::RO, &funct->tmax_increased, **comp);
    }
    return made;
}

Result<> Hal::set_safe_value(std::string_view name, const Value &value) {
    Guard guard(*impl_);
    PinRecord *pin = impl_->find_pin(name);
    if (pin == nullptr) {
        return impl_->no_such(Kind::PIN, name);
    }
    if (pin->type != value.type) {
        return refuse(EINVAL, fmt::format("pin '{}' is of type {}, its safe value of type {}", name,
                                          type_name(pin->type), type_name(value.type)));
    }
    pin->safe_value = value.bits;
    pin->has_safe_value = true;
    return {};
}

void Hal::Impl::remove_pin(PinRecord &pin) noexcept {
    unlink_pin(pin);
    if (auto *alias = segment.at<AliasRecord>(pin.alias)) {
        segment.remove(Kind::PIN_ALIAS, *alias);
    }
    segment.remove(Kind::PIN, pin);
}

void Hal::Impl::remove_param(ParamRecord &param) noexcept {
    if (auto *alias = segment.at<AliasRecord>(param.alias)) {
        segment.remove(Kind::PARAM_ALIAS, *alias);
    }
    segment.remove(Kind::PARAM, param);
}

void Hal::Impl::remove_funct(FunctRecord &funct) noexcept {
    drop_from_lists(segment.offset_of(&funct));
    segment.remove(Kind::FUNCT, funct);
}

namespace {

/// Sets the alias of `target`; an empty one removes it.
template <class Target>
Result<> set_alias(Hal::Impl &hal, Kind kind, Kind alias_kind, Target *target, std::string_view alias) {
    Segment &segment = hal.segment;
    if (!alias.empty()) {
        if (auto checked = hal.check_name(kind, alias); !checked) {
            return checked;
        }
    }
    if (auto *old = segment.at<AliasRecord>(target->alias)) {
        target->alias = 0;
        segment.remove(alias_kind, *old);
    }
    if (alias.empty()) {
        return {};
    }
    auto *record = segment.make<AliasRecord>(alias_kind, alias);
    if (record == nullptr) {
        return refuse(ENOMEM, fmt::format("alias '{}': no HAL memory left", alias));
    }
    record->target = segment.offset_of(target);
    segment.insert(alias_kind, *record);
    target->alias = segment.offset_of(record);
    return {};
}

}  // namespace

Result<> Hal::alias_pin(std::string_view name, std::string_view alias) {
    Guard guard(*impl_);
    if (auto checked = impl_->check_lock(LOCK_CONFIG, "aliases"); !checked) {
        return checked;
    }
    PinRecord *pin = impl_->find_pin(name);
    if (pin == nullptr) {
        return impl_->no_such(Kind::PIN, name);
    }
    return set_alias(*impl_, Kind::PIN, Kind::PIN_ALIAS, pin, alias);
}

Result<> Hal::alias_param(std::string_view name, std::string_view alias) {
    Guard guard(*impl_);
    if (auto checked = impl_->check_lock(LOCK_CONFIG, "aliases"); !checked) {
        return checked;
    }
    ParamRecord *param = impl_->find_param(name);
    if (param == nullptr) {
        return impl_->no_such(Kind::PARAM, name);
    }
    return set_alias(*impl_, Kind::PARAM, Kind::PARAM_ALIAS, param, alias);
}

}  // namespace mw::hal
