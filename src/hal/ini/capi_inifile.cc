// SPDX-License-Identifier: GPL-2.0-or-later
// inifile.h over config::IniFile.
#include <cerrno>
#include <cstring>
#include <limits>
#include <string>

#include "base/text.hh"
#include "config/ini_file.hh"
#include "config/ini_value.hh"
#include "hal/api/inifile.h"

namespace {

/// The value of the key in the whole file, wherever the stream stands; null when there is none.
const std::string *find(FILE *stream, const char *tag, const char *section) {
    thread_local std::string value;
    if (stream == nullptr || tag == nullptr || std::fseek(stream, 0, SEEK_SET) != 0) {
        return nullptr;
    }
    std::string text;
    char block[4096];
    for (std::size_t got = 0; (got = std::fread(block, 1, sizeof block, stream)) > 0;) {
        text.append(block, got);
    }
    mw::diag::Sink ignored;  // malformed lines are those of the one who loads the configuration
    const auto file = mw::config::IniFile::parse(text, "", ignored);
    for (const mw::config::IniEntry &entry : file.entries()) {
        if (entry.key == tag && (section == nullptr || entry.section == section)) {
            value = entry.value;
            return &value;
        }
    }
    return nullptr;
}

/// Hands the number over if it is one.
template <class T, class Number>
int hand_over(const Number &number, T *result) {
    if (!number) {
        return -EINVAL;
    }
    *result = static_cast<T>(*number);
    return 0;
}

}  // namespace

extern "C" {

const char *iniFind(FILE *fp, const char *tag, const char *section) {
    const std::string *value = find(fp, tag, section);
    return value == nullptr ? nullptr : value->c_str();
}

int iniFindInt(FILE *fp, const char *tag, const char *section, int *result) {
    rtapi_sint wide = 0;
    const int status = iniFindSInt(fp, tag, section, &wide);
    if (status != 0) {
        return status;
    }
    if (wide < std::numeric_limits<int>::min() || wide > std::numeric_limits<int>::max()) {
        return -EINVAL;
    }
    *result = static_cast<int>(wide);
    return 0;
}

int iniFindSInt(FILE *fp, const char *tag, const char *section, rtapi_sint *result) {
    const std::string *value = find(fp, tag, section);
    return value == nullptr ? -ENOENT : hand_over(mw::parse_int(*value), result);
}

int iniFindUInt(FILE *fp, const char *tag, const char *section, rtapi_uint *result) {
    const std::string *value = find(fp, tag, section);
    return value == nullptr ? -ENOENT : hand_over(mw::parse_uint(*value), result);
}

int iniFindDouble(FILE *fp, const char *tag, const char *section, double *result) {
    const std::string *value = find(fp, tag, section);
    return value == nullptr ? -ENOENT : hand_over(mw::parse_double(*value), result);
}

int iniFindBool(FILE *fp, const char *tag, const char *section, bool *result) {
    const std::string *value = find(fp, tag, section);
    if (value == nullptr) {
        return -ENOENT;
    }
    return hand_over(mw::config::ini_bool(*value), result);
}

int iniFindString(FILE *fp, const char *tag, const char *section, char *dest, size_t n) {
    const std::string *value = find(fp, tag, section);
    if (value == nullptr) {
        return -ENOENT;
    }
    if (dest == nullptr || value->size() >= n) {
        return dest == nullptr ? -EINVAL : -ENOSPC;
    }
    std::memcpy(dest, value->c_str(), value->size() + 1);
    return 0;
}

}  // extern "C"
