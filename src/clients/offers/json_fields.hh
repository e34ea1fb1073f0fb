// SPDX-License-Identifier: GPL-2.0-or-later
// Reads fields of a JSON object. Only source files of this folder include it.
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>

#include <fmt/format.h>

#include "clients/offers/offer.hh"

namespace mw::offers {

/// Remembers the first field that is missing or has another type; the values are then of no use.
class Fields {
  public:
    explicit Fields(const nlohmann::json &object) : object_(object) {
        if (!object.is_object()) {
            set_problem("an entry is not a JSON object");
        }
    }

    std::string text(const char *name) {
        const auto *const value = find(name);
        if (value == nullptr || !value->is_string()) {
            return set_problem(fmt::format("the text \"{}\" is missing", name)), "";
        }
        return value->get<std::string>();
    }
    /// An integer of that range.
    std::int64_t whole(const char *name, std::int64_t least, std::int64_t most) {
        const auto *const value = find(name);
        const bool isTooLarge = value != nullptr && value->is_number_unsigned() &&
                                value->get<std::uint64_t>() > static_cast<std::uint64_t>(most);
        const bool isInRange = value != nullptr && value->is_number_integer() && !isTooLarge &&
                               value->get<std::int64_t>() >= least && value->get<std::int64_t>() <= most;
        if (!isInRange) {
            return set_problem(fmt::format("\"{}\" must be an integer from {} to {}", name, least, most)),
                   least;
        }
        return value->get<std::int64_t>();
    }
    bool boolean(const char *name) {
        const auto *const value = find(name);
        if (value == nullptr || !value->is_boolean()) {
            return set_problem(fmt::format("\"{}\" must be true or false", name)), false;
        }
        return value->get<bool>();
    }
    /// An array with at most `most` entries; an empty one in case of a problem.
    const nlohmann::json &list(const char *name, std::size_t most) {
        static const nlohmann::json NONE = nlohmann::json::array();
        const auto *const value = find(name);
        if (value == nullptr || !value->is_array() || value->size() > most) {
            return set_problem(fmt::format("\"{}\" must be a list with at most {} entries", name, most)),
                   NONE;
        }
        return *value;
    }
    bool has(const char *name) const { return find(name) != nullptr; }
    void set_problem(std::string what) {
        if (problem_.empty()) {
            problem_ = std::move(what);
        }
    }
    void take_problem(const Fields &other) { set_problem(other.problem_); }
    const std::string &problem() const { return problem_; }

  private:
    const nlohmann::json *find(const char *name) const {
        const auto found = object_.is_object() ? object_.find(name) : object_.end();
        return object_.is_object() && found != object_.end() ? &*found : nullptr;
    }

    const nlohmann::json &object_;
    std::string problem_;
};

nlohmann::json json_of(const Offer &offer);
/// A checked offer.
Result<Offer> offer_of(const nlohmann::json &object);

}  // namespace mw::offers
