// SPDX-License-Identifier: GPL-2.0-or-later
#include "hal/core/detail/names.hh"

#include <fnmatch.h>

#include <cerrno>

#include "base/text.hh"

namespace mw::hal::detail {
namespace {

const char *kind_name(Kind kind) noexcept {
    switch (kind) {
    case Kind::COMP: return "component";
    case Kind::PIN: return "pin";
    case Kind::PARAM: return "parameter";
    case Kind::SIGNAL: return "signal";
    case Kind::FUNCT: return "function";
    case Kind::THREAD: return "thread";
    default: return "alias";
    }
}

}  // namespace

std::unexpected<Error> refuse(int code, std::string message, std::string hint) {
    errno = code;
    return fail(std::move(message), {}, std::move(hint));
}

Result<> check_name(const Segment &segment, Kind kind, std::string_view name) {
    if (name.empty() || name.size() > NAME_LENGTH) {
        return refuse(EINVAL, fmt::format("{} name '{}' has {} characters, 1 to {} are allowed",
                                          kind_name(kind), name, name.size(), NAME_LENGTH));
    }
    const bool taken = segment.find(kind, name) != nullptr ||
                       (kind == Kind::PIN && segment.find(Kind::PIN_ALIAS, name) != nullptr) ||
                       (kind == Kind::PARAM && segment.find(Kind::PARAM_ALIAS, name) != nullptr);
    if (taken) {
        const bool alias = kind == Kind::PIN_ALIAS || kind == Kind::PARAM_ALIAS;
        return refuse(EEXIST, alias ? fmt::format("there is an alias '{}' already", name)
                                    : fmt::format("there is a {} '{}' already", kind_name(kind), name));
    }
    return {};
}

Result<> check_lock(const Segment &segment, std::uint8_t lock, const char *what) {
    if ((segment.header().lock.load(std::memory_order_relaxed) & lock) != 0) {
        return refuse(EPERM, fmt::format("HAL is locked against {}", what),
                      "unlock it with the command 'unlock'");
    }
    return {};
}

std::unexpected<Error> no_such(const Segment &segment, Kind kind, std::string_view name) {
    std::vector<std::string> names;
    segment.each<Record>(kind, [&](Record &record) { names.emplace_back(record.name_view()); });
    const std::string near = nearest_name(name, names);
    return refuse(ENOENT, fmt::format("there is no {} '{}'", kind_name(kind), name),
                  near.empty() ? std::string() : fmt::format("did you mean '{}'?", near));
}

std::unexpected<Error> no_such_value(const Segment &segment, std::string_view name) {
    auto error = no_such(segment, Kind::PIN, name);
    error.error().message = fmt::format("there is no pin or parameter '{}'", name);
    return error;
}

bool isMatch(std::string_view glob, const std::string &name) {
    return glob == "*" || ::fnmatch(std::string(glob).c_str(), name.c_str(), 0) == 0;
}

std::string shown_name(const Segment &segment, const Record &record, Offset alias) {
    const auto *other = segment.at<AliasRecord>(alias);
    return std::string(other != nullptr ? other->name_view() : record.name_view());
}

}  // namespace mw::hal::detail
