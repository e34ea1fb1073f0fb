// SPDX-License-Identifier: GPL-2.0-or-later
#include "clients/nml/config/config_file.hh"

#include <algorithm>
#include <filesystem>

#include <fmt/format.h>

#include "base/atomic_file.hh"
#include "clients/nml/config/fields.hh"

namespace mw::nml {
namespace {

constexpr char COMMENT = '#';

std::vector<Word> words_of(std::string_view line, SourcePlace place) {
    constexpr std::string_view BLANK = " \t\r\v\f";
    std::vector<Word> words;
    std::size_t from = line.find_first_not_of(BLANK);
    while (from != std::string_view::npos) {
        const std::size_t end = std::min(line.find_first_of(BLANK, from), line.size());
        place.column = static_cast<int>(from) + 1;
        words.push_back({line.substr(from, end - from), place});
        from = line.find_first_not_of(BLANK, end);
    }
    return words;
}

/// Reads the fields of a line, then its options; false if there was an error, which has been reported.
template <class Line>
bool read_line(const std::vector<Word> &words, const LineForm<Line> &form, Line &line,
               diagnostics::Sink &sink) {
    const std::size_t given = words.size() - 1;  // the first word is the letter of the line
    line.place = words[0].place;
    if (given < form.fields.size()) {
        SourcePlace end = words.back().place;
        end.column += static_cast<int>(words.back().text.size());
        sink.error(fmt::format("field '{}' is missing: the line has {} of {}", form.fields[given].name, given,
                               form.fields.size()),
                   end, form.usage());
        return false;
    }
    bool is_good = true;
    for (std::size_t i = 0; i < form.fields.size(); ++i) {
        const auto status = form.fields[i].read(words[i + 1].text, line);
        if (!status.has_value()) {
            sink.error(fmt::format("field '{}': {}", form.fields[i].name, status.error().message),
                       words[i + 1].place, status.error().hint);
            is_good = false;
        }
    }
    for (std::size_t i = form.fields.size() + 1; i < words.size(); ++i) {
        is_good = read_option(words[i], form, line, sink) && is_good;
    }
    return is_good;
}

std::string place_text(const SourcePlace &place) {
    return fmt::format("line {}", place.line);
}

/// Errors of this line that depend on other lines.
bool check_buffer(const BufferSettings &buffer, const Config &config, diagnostics::Sink &sink) {
    for (const BufferSettings &other : config.buffers) {
        if (other.name == buffer.name) {
            sink.error(
                fmt::format("buffer '{}' is there already, in {}", buffer.name, place_text(other.place)),
                buffer.place);
            return false;
        }
        const bool shared = other.kind == BufferKind::SHMEM && buffer.kind == BufferKind::SHMEM;
        if (shared && other.key == buffer.key && other.host == buffer.host) {
            sink.error(fmt::format("key {} is that of buffer '{}' in {}: both would be one memory",
                                   buffer.key, other.name, place_text(other.place)),
                       buffer.place);
            return false;
        }
        const bool have_one_server = other.host == buffer.host &&
                                     ((buffer.tcp_port.has_value() && other.tcp_port == buffer.tcp_port) ||
                                      (buffer.stcp_port.has_value() && other.stcp_port == buffer.stcp_port) ||
                                      (buffer.udp_port.has_value() && other.udp_port == buffer.udp_port));
        if (have_one_server && other.buffer_number == buffer.buffer_number) {
            sink.error(fmt::format("buffer# {} is that of buffer '{}' in {}, which has the same port",
                                   buffer.buffer_number, other.name, place_text(other.place)),
                       buffer.place);
            return false;
        }
    }
    return true;
}

void tell_what_differs(const BufferSettings &buffer, diagnostics::Sink &sink) {
    if (buffer.mutex == Mutex::NO_INTERRUPTS || buffer.mutex == Mutex::NO_SWITCHING) {
        sink.warning(
            fmt::format("buffer '{}': Linux has no such mutex; it is used as mutex=os_sem", buffer.name),
            buffer.place);
    }
    if (!buffer.serial_device.empty()) {
        sink.warning(fmt::format("buffer '{}': messages do not go over serial lines; the option does nothing",
                                 buffer.name),
                     buffer.place, "use TCP=");
    }
}

/// Checks lines that name a buffer, after all buffers are known.
void check_processes(Config &config, diagnostics::Sink &sink) {
    std::vector<ProcessSettings> kept;
    for (ProcessSettings &process : config.processes) {
        const BufferSettings *buffer = config.find_buffer(process.buffer);
        const bool is_second =
            std::any_of(kept.begin(), kept.end(), [&process](const ProcessSettings &other) {
                return other.name == process.name && other.buffer == process.buffer;
            });
        if (is_second) {
            sink.error(
                fmt::format("process '{}' has a line for buffer '{}' already", process.name, process.buffer),
                process.place);
        } else if (buffer == nullptr && process.buffer != DEFAULT_BUFFER) {
            sink.warning(fmt::format("process '{}': there is no buffer '{}'; the line does nothing",
                                     process.name, process.buffer),
                         process.place);
        } else if (buffer != nullptr && process.connection_number >= buffer->max_processes) {
            sink.error(fmt::format("field 'c_num': {} is not below the {} processes of buffer '{}'",
                                   process.connection_number, buffer->max_processes, buffer->name),
                       process.place);
        } else {
            kept.push_back(std::move(process));
        }
    }
    config.processes = std::move(kept);
}

void take_line(std::string_view line, const SourcePlace &place, Config &config, diagnostics::Sink &sink) {
    const std::vector<Word> words = words_of(line, place);
    if (words.empty() || words[0].text.front() == COMMENT) {
        return;
    }
    const auto bad = std::find_if(words.begin(), words.end(), [](const Word &word) {
        return std::any_of(word.text.begin(), word.text.end(),
                           [](char c) { return static_cast<unsigned char>(c) < ' ' || c == '\x7f'; });
    });
    if (bad != words.end()) {
        sink.error("the line has a control character", bad->place);
        return;
    }
    if (words[0].text == "B") {
        BufferSettings buffer;
        if (read_line(words, buffer_form(), buffer, sink) && check_buffer(buffer, config, sink)) {
            tell_what_differs(buffer, sink);
            config.buffers.push_back(std::move(buffer));
        }
    } else if (words[0].text == "P") {
        ProcessSettings process;
        if (read_line(words, process_form(), process, sink)) {
            config.processes.push_back(std::move(process));
        }
    } else {
        sink.error(
            fmt::format("a line begins with B (buffer), P (process) or #, not with '{}'", words[0].text),
            words[0].place);
    }
}

}  // namespace

const BufferSettings *Config::find_buffer(std::string_view name) const {
    const auto found = std::find_if(buffers.begin(), buffers.end(),
                                    [name](const BufferSettings &buffer) { return buffer.name == name; });
    return found == buffers.end() ? nullptr : &*found;
}

const ProcessSettings *Config::find_process(std::string_view process, std::string_view buffer) const {
    for (const std::string_view wanted : {buffer, DEFAULT_BUFFER}) {
        for (const ProcessSettings &line : processes) {
            if (line.name == process && line.buffer == wanted) {
                return &line;
            }
        }
    }
    return nullptr;
}

Config parse_config(std::string_view text, const std::string &file, diagnostics::Sink &sink) {
    Config config;
    for (int number = 1; !text.empty(); ++number) {
        const std::size_t end = std::min(text.find('\n'), text.size());
        take_line(text.substr(0, end), {file, number, 1}, config, sink);
        text.remove_prefix(std::min(end + 1, text.size()));
    }
    check_processes(config, sink);
    return config;
}

Result<Config> load_config(const std::string &path, diagnostics::Sink &sink) {
    const auto text = read_file(path);
    if (!text.has_value()) {
        sink.error(text.error());
        return fail_told("the NML configuration cannot be read", {path, 0, 0});
    }
    const int before = sink.count_errors();
    Config config = parse_config(*text, path, sink);
    if (sink.count_errors() > before) {
        return fail_told("the NML configuration has wrong lines", {path, 0, 0});
    }
    const std::filesystem::path folder = std::filesystem::path(path).parent_path();
    for (BufferSettings &buffer : config.buffers) {
        for (std::string *file : {&buffer.password_file, &buffer.file}) {
            *file = file->empty() ? "" : (folder / *file).string();
        }
    }
    return config;
}

}  // namespace mw::nml
