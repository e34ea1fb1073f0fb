// SPDX-License-Identifier: GPL-2.0-or-later
// Signals, links and values.
#include <algorithm>
#include <cerrno>
#include <cstring>

#include "hal/core/detail/impl.hh"
#include "hal/include/hal.h"

namespace mw::hal {

using namespace detail;

SignalRecord *Hal::Impl::find_signal(std::string_view wanted) const noexcept {
    return segment.find_as<SignalRecord>(Kind::SIGNAL, wanted);
}

namespace {

std::int32_t &count_of(SignalRecord &signal, Dir dir) noexcept {
    return dir == Dir::IN ? signal.readers : dir == Dir::OUT ? signal.writers : signal.bidirectionals;
}

/// Name of a pin that writes the signal, for messages; a pin that is only about to be linked is not found.
std::string writer_of(const Hal::Impl &hal, const SignalRecord &signal) {
    std::string text = "another pin of the same net";
    const SignalRecord *real = hal.find_signal(signal.name_view());
    const Offset offset = real == nullptr ? 0 : hal.segment.offset_of(real);
    hal.segment.each<PinRecord>(Kind::PIN, [&](PinRecord &pin) {
        if (offset != 0 && pin.signal == offset && pin.dir != Dir::IN) {
            text = fmt::format("pin '{}'", pin.name_view());
        }
    });
    return text;
}

Result<SignalRecord *> make_signal(Hal::Impl &hal, std::string_view name, Type type) {
    if (auto checked = hal.check_name(Kind::SIGNAL, name); !checked) {
        return std::unexpected(checked.error());
    }
    auto *signal = hal.segment.make<SignalRecord>(Kind::SIGNAL, name);
    if (signal == nullptr) {
        return refuse(ENOMEM, fmt::format("signal '{}': no HAL memory left", name));
    }
    signal->type = type;
    hal.segment.insert(Kind::SIGNAL, *signal);
    return signal;
}

Result<Value> in_type(Type type, std::string_view name, const Value &value) {
    if (value.type != type) {
        return refuse(
            EINVAL, fmt::format("'{}' is of type {}, not {}", name, type_name(type), type_name(value.type)));
    }
    return value;
}

Result<Value> in_type(Type type, std::string_view name, std::string_view text) {
    auto value = parse_value(type, text);
    if (!value) {
        return refuse(EINVAL, fmt::format("'{}': {}", name, value.error().message));
    }
    return value;
}

template <class From>
Result<> set_pin_or_param(Hal::Impl &hal, std::string_view name, const From &from) {
    if (auto checked = hal.check_lock(LOCK_PARAMS, "setting parameters and pins"); !checked) {
        return checked;
    }
    if (const ParamRecord *param = hal.find_param(name)) {
        if (param->dir != Dir::RW) {
            return refuse(EPERM, fmt::format("parameter '{}' is read-only", name));
        }
        const auto value = in_type(param->type, name, from);
        if (!value) {
            return std::unexpected(value.error());
        }
        hal.write(param->address, *value);
        return {};
    }
    PinRecord *pin = hal.find_pin(name);
    if (pin == nullptr) {
        auto error = hal.no_such(Kind::PIN, name);
        error.error().message = fmt::format("there is no pin or parameter '{}'", name);
        return error;
    }
    if (pin->dir == Dir::OUT) {
        return refuse(EPERM, fmt::format("pin '{}' is an output, its component sets it", name));
    }
    if (pin->signal != 0) {
        return refuse(EPERM,
                      fmt::format("pin '{}' is linked to signal '{}'", name,
                                  hal.segment.at<SignalRecord>(pin->signal)->name_view()),
                      "set the signal instead");
    }
    const auto value = in_type(pin->type, name, from);
    if (!value) {
        return std::unexpected(value.error());
    }
    hal.write(hal.value_of(*pin), *value);
    return {};
}

template <class From>
Result<> set_signal_value(Hal::Impl &hal, std::string_view name, const From &from) {
    if (auto checked = hal.check_lock(LOCK_PARAMS, "setting signals"); !checked) {
        return checked;
    }
    SignalRecord *signal = hal.find_signal(name);
    if (signal == nullptr) {
        return hal.no_such(Kind::SIGNAL, name);
    }
    if (signal->type == Type::PORT) {
        const auto size = in_type(Type::PORT, name, from);
        return size ? hal.make_queue(*signal, size->as_u32()) : Result<>(std::unexpected(size.error()));
    }
    if (signal->writers > 0) {
        return refuse(EPERM, fmt::format("signal '{}' is written by {}", name, writer_of(hal, *signal)));
    }
    const auto value = in_type(signal->type, name, from);
    if (!value) {
        return std::unexpected(value.error());
    }
    hal.write(signal->value, *value);
    return {};
}

}  // namespace

// ---- links, with the lock held

Result<> Hal::Impl::check_link(const PinRecord &pin, const SignalRecord &signal) const {
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
                                          writer_of(*this, signal)));
    }
    return {};
}

void Hal::Impl::link_pin(PinRecord &pin, SignalRecord &signal) noexcept {
    if (pin.signal == segment.offset_of(&signal)) {
        return;
    }
    // The queue of a port belongs to the signal.
    if (signal.type != Type::PORT && signal.readers + signal.writers + signal.bidirectionals == 0) {
        write(signal.value, read(pin.type, pin.value));
    }
    pin.signal = segment.offset_of(&signal);
    ++count_of(signal, pin.dir);
    point_slot(pin, signal.value);
}

void Hal::Impl::unlink_pin(PinRecord &pin) noexcept {
    auto *signal = segment.at<SignalRecord>(pin.signal);
    if (signal == nullptr) {
        return;
    }
    if (signal->type != Type::PORT) {
        write(pin.value, read(pin.type, signal->value));
    }
    pin.signal = 0;
    --count_of(*signal, pin.dir);
    point_slot(pin, pin.value);
}

Result<> Hal::Impl::make_queue(SignalRecord &signal, std::uint32_t size) {
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

// ---- public

Result<> Hal::new_signal(std::string_view name, Type type) {
    Guard guard(*impl_);
    if (auto checked = impl_->check_lock(LOCK_CONFIG, "new signals"); !checked) {
        return checked;
    }
    auto made = make_signal(*impl_, name, type);
    return made ? Result<>{} : std::unexpected(made.error());
}

Result<> Hal::delete_signal(std::string_view name) {
    Guard guard(*impl_);
    if (auto checked = impl_->check_lock(LOCK_CONFIG, "removing signals"); !checked) {
        return checked;
    }
    SignalRecord *signal = impl_->find_signal(name);
    if (signal == nullptr) {
        return impl_->no_such(Kind::SIGNAL, name);
    }
    const Offset offset = impl_->segment.offset_of(signal);
    impl_->segment.each<PinRecord>(Kind::PIN, [&](PinRecord &pin) {
        if (pin.signal == offset) {
            impl_->unlink_pin(pin);
        }
    });
    impl_->segment.remove(Kind::SIGNAL, *signal);
    return {};
}

Result<> Hal::link(std::string_view pin_name, std::string_view signal_name) {
    Guard guard(*impl_);
    if (auto checked = impl_->check_lock(LOCK_CONFIG, "links"); !checked) {
        return checked;
    }
    PinRecord *pin = impl_->find_pin(pin_name);
    if (pin == nullptr) {
        return impl_->no_such(Kind::PIN, pin_name);
    }
    SignalRecord *signal = impl_->find_signal(signal_name);
    if (signal == nullptr) {
        return impl_->no_such(Kind::SIGNAL, signal_name);
    }
    if (auto checked = impl_->check_link(*pin, *signal); !checked) {
        return checked;
    }
    impl_->link_pin(*pin, *signal);
    return {};
}

Result<> Hal::unlink(std::string_view name) {
    Guard guard(*impl_);
    if (auto checked = impl_->check_lock(LOCK_CONFIG, "links"); !checked) {
        return checked;
    }
    PinRecord *pin = impl_->find_pin(name);
    if (pin == nullptr) {
        return impl_->no_such(Kind::PIN, name);
    }
    impl_->unlink_pin(*pin);
    return {};
}

Result<> Hal::net(std::string_view signal_name, const std::vector<std::string> &pins) {
    Guard guard(*impl_);
    if (auto checked = impl_->check_lock(LOCK_CONFIG, "links"); !checked) {
        return checked;
    }
    std::vector<PinRecord *> records;
    for (const std::string &name : pins) {
        records.push_back(impl_->find_pin(name));
        if (records.back() == nullptr) {
            return impl_->no_such(Kind::PIN, name);
        }
    }
    SignalRecord *signal = impl_->find_signal(signal_name);
    if (signal == nullptr && records.empty()) {
        return impl_->no_such(Kind::SIGNAL, signal_name);
    }
    if (signal == nullptr && impl_->find_pin(signal_name) != nullptr) {
        return refuse(EINVAL, fmt::format("'{}' is the name of a pin", signal_name),
                      "the first word after net is the signal's name");
    }
    // Tries on a copy, so that nothing changes unless all pins can be linked.
    SignalRecord trial{};
    if (signal != nullptr) {
        trial.type = signal->type;
        trial.readers = signal->readers;
        trial.writers = signal->writers;
        trial.bidirectionals = signal->bidirectionals;
    } else {
        trial.type = records.front()->type;
        if (auto checked = impl_->check_name(Kind::SIGNAL, signal_name); !checked) {
            return checked;
        }
    }
    std::memcpy(trial.name.data(), signal_name.data(), std::min(signal_name.size(), NAME_LENGTH));
    for (auto at = records.begin(); at != records.end(); ++at) {
        PinRecord *pin = *at;
        const bool is_linked = signal != nullptr && pin->signal == impl_->segment.offset_of(signal);
        if (is_linked || std::find(records.begin(), at, pin) != at) {
            continue;
        }
        if (auto checked = impl_->check_link(*pin, trial); !checked) {
            return checked;
        }
        ++count_of(trial, pin->dir);
    }
    if (signal == nullptr) {
        auto made = make_signal(*impl_, signal_name, trial.type);
        if (!made) {
            return std::unexpected(made.error());
        }
        signal = *made;
    }
    for (PinRecord *pin : records) {
        impl_->link_pin(*pin, *signal);
    }
    return {};
}

// ---- values

Value Hal::Impl::read(Type type, Offset value) const noexcept {
    const void *at = segment.at<void>(value);
    switch (type) {
    case Type::BIT:
        return Value{type, __atomic_load_n(static_cast<const std::uint8_t *>(at), __ATOMIC_RELAXED)};
    case Type::S32:
    case Type::U32:
    case Type::PORT:
        return Value{type, __atomic_load_n(static_cast<const std::uint32_t *>(at), __ATOMIC_RELAXED)};
    default: return Value{type, __atomic_load_n(static_cast<const std::uint64_t *>(at), __ATOMIC_RELAXED)};
    }
}

void Hal::Impl::write(Offset value, const Value &from) noexcept {
    void *at = segment.at<void>(value);
    switch (from.type) {
    case Type::BIT:
        __atomic_store_n(static_cast<std::uint8_t *>(at), static_cast<std::uint8_t>(from.bits),
                         __ATOMIC_RELAXED);
        break;
    case Type::S32:
    case Type::U32:
    case Type::PORT:
        __atomic_store_n(static_cast<std::uint32_t *>(at), static_cast<std::uint32_t>(from.bits),
                         __ATOMIC_RELAXED);
        break;
    default: __atomic_store_n(static_cast<std::uint64_t *>(at), from.bits, __ATOMIC_RELAXED);
    }
}

Result<Value> Hal::get_pin(std::string_view name) const {
    Guard guard(*impl_);
    const PinRecord *pin = impl_->find_pin(name);
    if (pin == nullptr) {
        return impl_->no_such(Kind::PIN, name);
    }
    return impl_->read(pin->type, impl_->value_of(*pin));
}

Result<Value> Hal::get_signal(std::string_view name) const {
    Guard guard(*impl_);
    const SignalRecord *signal = impl_->find_signal(name);
    if (signal == nullptr) {
        return impl_->no_such(Kind::SIGNAL, name);
    }
    return impl_->read(signal->type, signal->value);
}

Result<Value> Hal::get_param(std::string_view name) const {
    Guard guard(*impl_);
    const ParamRecord *param = impl_->find_param(name);
    if (param == nullptr) {
        return impl_->no_such(Kind::PARAM, name);
    }
    return impl_->read(param->type, param->address);
}

Result<Value> Hal::get(std::string_view name) const {
    Guard guard(*impl_);
    if (const ParamRecord *param = impl_->find_param(name)) {
        return impl_->read(param->type, param->address);
    }
    if (const PinRecord *pin = impl_->find_pin(name)) {
        return impl_->read(pin->type, impl_->value_of(*pin));
    }
    auto error = impl_->no_such(Kind::PIN, name);
    error.error().message = fmt::format("there is no pin or parameter '{}'", name);
    return error;
}

Result<> Hal::set(std::string_view name, const Value &value) {
    Guard guard(*impl_);
    return set_pin_or_param(*impl_, name, value);
}

Result<> Hal::set(std::string_view name, std::string_view text) {
    Guard guard(*impl_);
    return set_pin_or_param(*impl_, name, text);
}

Result<> Hal::set_signal(std::string_view name, const Value &value) {
    Guard guard(*impl_);
    return set_signal_value(*impl_, name, value);
}

Result<> Hal::set_signal(std::string_view name, std::string_view text) {
    Guard guard(*impl_);
    return set_signal_value(*impl_, name, text);
}

Result<> Hal::force(std::string_view name, const Value &value) {
    auto address = address_of(name, value.type);
    if (!address) {
        return std::unexpected(address.error());
    }
    Guard guard(*impl_);
    impl_->write(impl_->segment.offset_of(const_cast<const void *>(*address)), value);
    return {};
}

Result<volatile void *> Hal::address_of(std::string_view name, Type type) {
    Guard guard(*impl_);
    Type found = type;
    Offset value = 0;
    if (const ParamRecord *param = impl_->find_param(name)) {
        found = param->type;
        value = param->address;
    } else if (const PinRecord *pin = impl_->find_pin(name)) {
        found = pin->type;
        value = impl_->value_of(*pin);
    } else if (const SignalRecord *signal = impl_->find_signal(name)) {
        found = signal->type;
        value = signal->value;
    } else {
        return impl_->no_such(Kind::PIN, name);
    }
    if (found != type) {
        return refuse(EINVAL,
                      fmt::format("'{}' is of type {}, not {}", name, type_name(found), type_name(type)));
    }
    return impl_->segment.at<void>(value);
}

}  // namespace mw::hal
