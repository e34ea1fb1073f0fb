// SPDX-License-Identifier: GPL-2.0-or-later
// The components of an instance. Invariant: ids and names are unique, and a component is removed together
// with everything that it owns. Not realtime-safe. [any non-realtime thread and process]
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "base/result.hh"

namespace mw::hal {

namespace detail {
class Segment;
}
class ControllerWatches;

enum class CompType : std::int8_t { USER = 0, REALTIME = 1, OTHER = 2 };

struct CompInfo {
    std::string name;
    int id = 0;
    CompType type = CompType::USER;
    bool isReady = false;
    int pid = 0;
    std::string insmod_args;  ///< parameters from loadrt; empty for programs
    bool is_loaded_by_loadrt = false;
};

class Components {
  public:
    Components(detail::Segment &segment, ControllerWatches &watches) : segment_(segment), watches_(watches) {}

    /// Adds a component of this process; returns its id.
    Result<int> create(std::string_view name, CompType type = CompType::USER);
    Result<> set_ready(int comp_id, bool isReady = true);
    /// Removes a component: its functions leave the threads, and its pins, parameters and functions are
    /// removed.
    Result<> remove(int comp_id);
    Result<> set_insmod_args(int comp_id, std::string_view args);

    /// Sorted by name; `glob` takes * ? [abc].
    std::vector<CompInfo> list(std::string_view glob = "*") const;
    bool has(std::string_view name) const;
    /// An error includes the most similar name.
    Result<CompInfo> find(std::string_view name) const;
    Result<CompInfo> find(int comp_id) const;
    /// The name in the memory of the instance, valid until the component is removed; null if there is none.
    char *stored_name(int comp_id) const;
    /// Id of the next component that any process adds.
    int next_id() const;

    /// Makes another instance of a loaded component from a name and an argument; returns 0 or a negated
    /// errno.
    using Constructor = int (*)(const char *, const char *);
    /// Only for components of this process.
    void set_constructor(int comp_id, Constructor make);
    /// Null when the component has none.
    Constructor constructor(int comp_id) const;

  private:
    detail::Segment &segment_;
    ControllerWatches &watches_;
    std::map<int, Constructor> constructors_;  ///< by component id; under the segment's lock
};

}  // namespace mw::hal
