// SPDX-License-Identifier: GPL-2.0-or-later
// A type of board as a text table: names, ports, modules and pins. The folder `models` has the built-in
// models.
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "base/result.hh"
#include "drivers/mesa/identity/idrom.hh"

namespace mw::mesa::board {

struct Model {
    std::string card_name;  ///< name as reported by the card, at most 16 characters: 7I76E-16
    std::uint16_t lbp_version = 3, firmware_version = 15;
    std::uint8_t flash_id = 0x14;  ///< 0x13: 8 Mbit, 0x14: 16 Mbit, 0x15: 32 Mbit
    Idrom idrom;

    bool operator==(const Model &) const = default;
};

/// The model of a text; `file` is its name in errors.
Result<Model> parse_model(std::string_view text, const std::string &file);

/// The text from which parse_model() creates `model`, for instance that of a real board; an error if such a
/// text cannot describe it.
Result<std::string> write_model(const Model &model);

/// A model that is part of the library.
struct BuiltInModel {
    std::string_view name, text;
};
std::span<const BuiltInModel> built_in_models() noexcept;
/// The built-in model of that name; if the name contains a slash or a dot, the model in that file.
Result<Model> load_model(const std::string &name);

}  // namespace mw::mesa::board
