// SPDX-License-Identifier: GPL-2.0-or-later
// A field of the status by its path of names, as in "joints.pos_fb".
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "clients/publish/table.hh"

namespace mw::publish {

/// At most one part of a path is an array; `index` selects its element.
class FieldPath {
  public:
    /// Nothing if the status has no such field, or if the field has parts.
    static std::optional<FieldPath> find(std::string_view path);
    /// The first of several paths separated by blanks.
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

/// Paths of all fields of the status without parts.
std::vector<std::string> all_fields();

/// Type of the field, or of the calculated value.
DataType type_of(const Row &row);

}  // namespace mw::publish
