// SPDX-License-Identifier: GPL-2.0-or-later
#include "clients/screen/files/message_log.hh"

#include <array>
#include <cerrno>
#include <filesystem>
#include <fstream>
#include <system_error>

namespace mw::screen {

namespace {

std::string line_of(std::time_t when, std::string_view text) {
    std::tm local{};
    ::localtime_r(&when, &local);
    std::array<char, 32> stamp{};
    std::string line(stamp.data(), std::strftime(stamp.data(), stamp.size(), "%Y-%m-%d %H:%M:%S ", &local));
    const std::size_t end = text.find_last_not_of('\n');
    for (const char c : text.substr(0, end == std::string_view::npos ? 0 : end + 1)) {
        line += c == '\n' ? std::string(" / ") : std::string(1, c);
    }
    return line + '\n';
}

}  // namespace

Result<> MessageLog::add(std::time_t when, std::string_view text) {
    const std::string line = line_of(when, text);
    std::error_code error;
    const std::uintmax_t size = std::filesystem::file_size(path_, error);
    if (!error && size + line.size() > most_bytes_) {
        std::filesystem::rename(path_, path_ + ".1", error);
        if (error) {
            return fail("[DISPLAY]LOG_FILE " + path_ + ": " + error.message());
        }
    }
    errno = 0;
    std::ofstream file(path_, std::ios::app);
    file << line << std::flush;
    if (!file) {
        return fail("[DISPLAY]LOG_FILE " + path_ + ": " +
                    (errno != 0 ? std::generic_category().message(errno) : "it cannot be written"));
    }
    return {};
}

}  // namespace mw::screen
