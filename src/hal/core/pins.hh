// SPDX-License-Identifier: GPL-2.0-or-later
// The pins of an instance. Invariant: a pin's slot, in memory of its component, always points to a value of
// the pin's type: its own value or the value of its signal. A pin is found by its name and by its alias. Not
// realtime-safe, unless stated otherwise. [any non-realtime thread and process]
#pragma once

#include <atomic>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "base/result.hh"
#include "hal/core/value.hh"

namespace mw::hal {

namespace detail {
class Segment;
}

struct PinInfo {
    std::string name;           ///< the alias if there is one
    std::string original_name;  ///< empty unless there is an alias
    Type type = Type::BIT;
    Dir dir = Dir::IN;
    int owner_id = 0;
    std::string owner;
    std::string signal;  ///< empty when not linked
    Value value;
};

class Pins {
  public:
    explicit Pins(detail::Segment &segment) : segment_(segment) {}

    /// `slot` must be in memory of Memory::allocate(); it points to the value from then on.
    Result<> create(std::string_view name, Type type, Dir dir, void **slot, int comp_id);
    /// A pin with its own slot, for programs without a struct; read and write through the returned slot.
    Result<void **> create(std::string_view name, Type type, Dir dir, int comp_id);
    /// The value that an output takes when its process dies; without a declaration 0 or FALSE.
    Result<> set_safe_value(std::string_view name, const Value &value);
    /// An empty alias removes the alias.
    Result<> set_alias(std::string_view name, std::string_view alias);

    /// Sorted by name; `glob` takes * ? [abc] and is matched with the name and the alias.
    std::vector<PinInfo> list(std::string_view glob = "*") const;
    bool has(std::string_view name) const;
    /// An error includes the most similar name.
    Result<PinInfo> find(std::string_view name) const;
    Result<Value> get(std::string_view name) const;
    /// Number of changes of slots by links and unlinks; a change means that values must be written again.
    /// [any thread, realtime-safe]
    const std::atomic<std::uint32_t> &link_changes() const noexcept;

  private:
    detail::Segment &segment_;
};

}  // namespace mw::hal
