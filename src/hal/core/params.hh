// SPDX-License-Identifier: GPL-2.0-or-later
// The parameters of an instance. Invariant: a parameter's value stays in memory of its component. A parameter
// is found by its name and by its alias. Not realtime-safe. [any non-realtime thread and process]
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

struct ParamInfo {
    std::string name;
    std::string original_name;
    Type type = Type::BIT;
    Dir dir = Dir::RO;
    int owner_id = 0;
    std::string owner;
    Value value;
};

class Params {
  public:
    explicit Params(detail::Segment &segment) : segment_(segment) {}

    /// `address` must be in memory of Memory::allocate().
    Result<> create(std::string_view name, Type type, Dir dir, void *address, int comp_id);
    /// An empty alias removes the alias.
    Result<> set_alias(std::string_view name, std::string_view alias);

    /// Sorted by name; `glob` takes * ? [abc] and is matched with the name and the alias.
    std::vector<ParamInfo> list(std::string_view glob = "*") const;
    bool has(std::string_view name) const;
    /// An error includes the most similar name.
    Result<ParamInfo> find(std::string_view name) const;
    Result<Value> get(std::string_view name) const;

  private:
    detail::Segment &segment_;
};

}  // namespace mw::hal
