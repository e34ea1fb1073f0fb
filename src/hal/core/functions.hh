// SPDX-License-Identifier: GPL-2.0-or-later
// The functions of realtime components. Invariant: a function has a pin .time and the parameters .tmax and
// .tmax-increased, and is in threads only while it exists (threads.hh has their order).
// Not realtime-safe. [any non-realtime thread and process]
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "base/result.hh"

namespace mw::hal {

namespace detail {
class Segment;
}

struct FunctionInfo {
    std::string name;
    int owner_id = 0;
    std::string owner;
    int users = 0;  ///< number of uses in threads
    bool reentrant = false;
    bool usesFloat = false;
    std::uint64_t address = 0;  ///< in the memory of the realtime process
    std::uint64_t argument = 0;
};

/// The function that a thread calls, as function(argument, period in ns).
struct FunctionCode {
    void (*function)(void *, long) = nullptr;
    void *argument = nullptr;
    bool reentrant = false;  ///< may be in several threads
    bool usesFloat = true;
};

class Functions {
  public:
    explicit Functions(detail::Segment &segment) : segment_(segment) {}

    Result<> create(std::string_view name, const FunctionCode &code, int comp_id);
    /// Sorted by name; `glob` takes * ? [abc].
    std::vector<FunctionInfo> list(std::string_view glob = "*") const;

  private:
    detail::Segment &segment_;
};

}  // namespace mw::hal
