// SPDX-License-Identifier: GPL-2.0-or-later
// A field of the status by its path of names, "joints.pos_fb", as the declarations have them.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "clients/publish/table.hh"

namespace mw::publish {

/// At most one part of a path has several elements: `index` selects one.
class FieldPath {
  public:
    /// Nothing when the status has no such field, or when it has parts itself.
    static std::optional<FieldPath> find(std::string_view path);
    /// The first of several paths that are separated by blanks.
    static std::string_view first_of(std::string_view paths);

    Value read(const messages::MachineStatus &status, int index) const;
    const char *unit() const { return last().unit; }
    const char *doc() const { return last().doc; }
    const messages::Type &type() const { return last().type; }

  private:
    const messages::Field &last() const { return *fields_[count_ - 1]; }

    static constexpr std::size_t MOST = 4;
    std::array<const messages::Field *, MOST> fields_{};
    std::size_t count_ = 0;
};

/// Paths of all fields of the status that have no parts.
std::vector<std::string> all_fields();

/// Of the field, or of what is calculated.
DataType type_of(const Row &row);

}  // namespace mw::publish
