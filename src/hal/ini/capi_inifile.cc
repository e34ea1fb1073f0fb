// SPDX-License-Identifier: GPL-2.0-or-later
// inifile.h over ini::IniFile.
#include <cerrno>
#include <cstring>
#include <limits>
#include <string>

#include "base/ini/ini_file.hh"
#include "base/ini/ini_value.hh"
#include "base/text.hh"
#include "hal/include/inifile.h"

namespace {

/// The value of the key; null when there is none.
const std::string *find(const mw::ini::IniFile &file, const char *tag, const char *section) {
    thread_local std::string value;
    for (const mw::ini::IniEntry &entry : file.entries()) {
        if (entry.key == tag && (section == nullptr || entry.section == section)) {
            value = entry.value;
            return &value;
        }
    }
    return nullptr;
}

/// Searches the whole file, independent of the stream's position.
const std::string *find(FILE *stream, const char *tag, const char *section) {
    if (stream == nullptr || tag == nullptr || std::fseek(stream, 0, SEEK_SET) != 0) {
        return nullptr;
    }
    std::string text;
    char block[4096];
    for (std::size_t got = 0; (got = std::fread(block, 1, sizeof block, stream)) > 0;) {
        text.append(block, got);
    }
    mw::diagnostics::Sink ignored;  // the program that loads the configuration reports malformed lines
    return find(mw::ini::IniFile::parse(text, "", ignored), tag, section);
}

const std::string *find(const char *name, const char *tag, const char *section) {
    if (name == nullptr || tag == nullptr) {
        return nullptr;
    }
    mw::diagnostics::Sink ignored;
    const auto file = mw::ini::IniFile::load(name, ignored);
    return file ? find(*file, tag, section) : nullptr;
}

/// Stores the number if it is valid.
template <class T, class Number>
int hand_over(const Number &number, T *result) {
    if (!number) {
        return -EINVAL;
    }
    *result = static_cast<T>(*number);
    return 0;
}

int to_int(const std::string *value, int *result) {
    if (value == nullptr) {
        return -ENOENT;
    }
    const auto wide = mw::parse_int(*value);
    const bool is_int =
        wide && *wide >= std::numeric_limits<int>::min() && *wide <= std::numeric_limits<int>::max();
    return is_int ? hand_over(wide, result) : -EINVAL;
}

int to_text(const std::string *value, char *dest, std::size_t n) {
    if (value == nullptr) {
        return -ENOENT;
    }
    if (dest == nullptr || value->size() >= n) {
        return dest == nullptr ? -EINVAL : -ENOSPC;
    }
    std::memcpy(dest, value->c_str(), value->size() + 1);
    return 0;
}

const char *c_text(const std::string *value) {
    return value == nullptr ? nullptr : value->c_str();
}

}  // namespace

extern "C" {

const char *iniFind(FILE *file, const char *tag, const char *section) {
    return c_text(find(file, tag, section));
}

int iniFindInt(FILE *file, const char *tag, const char *section, int *result) {
    return to_int(find(file, tag, section), result);
}

int iniFindSInt(FILE *file, const char *tag, const char *section, rtapi_sint *result) {
    const std::string *value = find(file, tag, section);
    return value == nullptr ? -ENOENT : hand_over(mw::parse_int(*value), result);
}

int iniFindUInt(FILE *file, const char *tag, const char *section, rtapi_uint *result) {
    const std::string *value = find(file, tag, section);
    return value == nullptr ? -ENOENT : hand_over(mw::parse_uint(*value), result);
}

int iniFindDouble(FILE *file, const char *tag, const char *section, double *result) {
    const std::string *value = find(file, tag, section);
    return value == nullptr ? -ENOENT : hand_over(mw::parse_double(*value), result);
}

int iniFindBool(FILE *file, const char *tag, const char *section, bool *result) {
    const std::string *value = find(file, tag, section);
    return value == nullptr ? -ENOENT : hand_over(mw::ini::ini_bool(*value), result);
}

int iniFindString(FILE *file, const char *tag, const char *section, char *dest, size_t n) {
    return to_text(find(file, tag, section), dest, n);
}

const char *iniFindIn(const char *file, const char *tag, const char *section) {
    return c_text(find(file, tag, section));
}

int iniFindIntIn(const char *file, const char *tag, const char *section, int *result) {
    return to_int(find(file, tag, section), result);
}

int iniFindSIntIn(const char *file, const char *tag, const char *section, rtapi_sint *result) {
    const std::string *value = find(file, tag, section);
    return value == nullptr ? -ENOENT : hand_over(mw::parse_int(*value), result);
}

int iniFindUIntIn(const char *file, const char *tag, const char *section, rtapi_uint *result) {
    const std::string *value = find(file, tag, section);
    return value == nullptr ? -ENOENT : hand_over(mw::parse_uint(*value), result);
}

int iniFindDoubleIn(const char *file, const char *tag, const char *section, double *result) {
    const std::string *value = find(file, tag, section);
    return value == nullptr ? -ENOENT : hand_over(mw::parse_double(*value), result);
}

int iniFindBoolIn(const char *file, const char *tag, const char *section, bool *result) {
    const std::string *value = find(file, tag, section);
    return value == nullptr ? -ENOENT : hand_over(mw::ini::ini_bool(*value), result);
}

int iniFindStringIn(const char *file, const char *tag, const char *section, char *dest, size_t n) {
    return to_text(find(file, tag, section), dest, n);
}

}  // extern "C"
