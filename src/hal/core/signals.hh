// SPDX-License-Identifier: GPL-2.0-or-later
// The signals of an instance and their links. Invariant: all pins of a signal have its type, and at most one
// of them is an output, with no I/O pin beside it. Not realtime-safe. [any non-realtime thread and process]
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "base/result.hh"
#include "hal/core/value.hh"

namespace mw::hal {

namespace detail {
class Segment;
}

struct SignalPin {
    std::string name;
    Dir dir = Dir::IN;
};

struct SignalInfo {
    std::string name;
    Type type = Type::BIT;
    Value value;
    int readers = 0;
    int writers = 0;
    int bidirectionals = 0;
    std::vector<SignalPin> pins;  ///< sorted by name
};

class Signals {
  public:
    explicit Signals(detail::Segment &segment) : segment_(segment) {}

    Result<> create(std::string_view name, Type type);
    Result<> remove(std::string_view name);
    Result<> link(std::string_view pin, std::string_view signal);
    Result<> unlink(std::string_view pin);
    /// As halcmd's net: creates the signal with the first pin's type unless it exists, and links every pin.
    /// Everything is checked first: a failure changes nothing.
    Result<> net(std::string_view signal, const std::vector<std::string> &pins);

    /// Sorted by name; `glob` takes * ? [abc].
    std::vector<SignalInfo> list(std::string_view glob = "*") const;
    bool has(std::string_view name) const;
    /// An error includes the most similar name.
    Result<SignalInfo> find(std::string_view name) const;
    Result<Value> get(std::string_view name) const;
    /// Like the command sets: rejected while the signal has a writer. The value of a port signal is the size
    /// of its buffer.
    Result<> set(std::string_view name, const Value &value);
    Result<> set(std::string_view name, std::string_view text);

  private:
    detail::Segment &segment_;
};

}  // namespace mw::hal
