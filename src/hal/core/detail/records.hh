// SPDX-License-Identifier: GPL-2.0-or-later
// Records of components and of the objects that they own, for several registries. The caller holds the
// segment's lock.
#pragma once

#include <string_view>

#include "base/result.hh"
#include "hal/core/detail/segment.hh"

namespace mw::hal::detail {

CompRecord *find_comp(const Segment &segment, int comp_id) noexcept;
/// Finds a pin by name or alias.
PinRecord *find_pin(const Segment &segment, std::string_view name) noexcept;
ParamRecord *find_param(const Segment &segment, std::string_view name) noexcept;

/// Adds a component of this process; returns its id.
Result<int> add_comp(Segment &segment, std::string_view name, CompType type);
/// The component to which a pin, parameter or function can be added: only the process that owns it may create
/// them, since their addresses are in its memory. `what` names the object in messages.
Result<CompRecord *> comp_for_new(const Segment &segment, int comp_id, std::string_view name,
                                  const char *what);
/// A pin as its component declares it.
struct PinDeclaration {
    std::string_view name;
    Type type;
    Dir dir;
    void **slot;
};
Result<> add_pin(Segment &segment, CompRecord &comp, const PinDeclaration &declared);
/// A parameter as its component declares it.
struct ParamDeclaration {
    std::string_view name;
    Type type;
    Dir dir;
    void *address;
};
Result<> add_param(Segment &segment, CompRecord &comp, const ParamDeclaration &declared);

enum class Outputs { AS_THEY_ARE, SAFE };
/// Removes a component and its objects; its outputs first take safe values or leave their values in the
/// signals.
void remove_comp(Segment &segment, CompRecord &comp, Outputs outputs) noexcept;

/// Position of a pin's value: in its signal if it is linked, else its own.
Offset value_of(const Segment &segment, const PinRecord &pin) noexcept;
Value value_at(const Segment &segment, Type type, Offset value) noexcept;
void set_safe_value(const Segment &segment, const PinRecord &pin) noexcept;

/// Number of a signal's pins of this direction.
std::int32_t &count_of(SignalRecord &signal, Dir dir) noexcept;
/// The type must match, and the signal must have no writer yet if the pin writes.
void link_pin(Segment &segment, PinRecord &pin, SignalRecord &signal) noexcept;
void unlink_pin(Segment &segment, PinRecord &pin) noexcept;

}  // namespace mw::hal::detail
