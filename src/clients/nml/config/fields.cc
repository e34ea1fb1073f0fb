// SPDX-License-Identifier: GPL-2.0-or-later
#include "clients/nml/config/fields.hh"

#include <algorithm>
#include <array>
#include <vector>

#include "base/text.hh"

namespace mw::nml {
namespace {

constexpr std::int64_t MAX_SIZE = 64LL << 20U;
constexpr std::int64_t MAX_NUMBER = 0x7fffffff;
constexpr std::int64_t MAX_PORT = 65535;
constexpr std::int64_t MAX_PROCESSES = 256;
constexpr std::int64_t MAX_COPIES = 16;
constexpr std::size_t MAX_NAME = 127;

template <class E>
struct Choice {
    std::string_view name;
    E value;
};

template <class E, std::size_t N>
Result<> choose(std::string_view word, const std::array<Choice<E>, N> &choices, E &value) {
    std::string names;
    for (const Choice<E> &choice : choices) {
        if (equals_ignoring_case(word, choice.name)) {
            value = choice.value;
            return {};
        }
        names += fmt::format("{}{}", names.empty() ? "" : ", ", choice.name);
    }
    return fail(fmt::format("'{}' is not one of {}", word, names));
}

template <class T>
Result<> whole_number(std::string_view word, std::int64_t least, std::int64_t most, T &value) {
    const auto number = parse_int(word);
    if (!number.has_value() || *number < least || *number > most) {
        return fail(fmt::format("'{}' is not a whole number from {} to {}", word, least, most));
    }
    value = static_cast<T>(*number);
    return {};
}

Result<> yes_or_no(std::string_view word, bool &value) {
    if (word != "0" && word != "1") {
        return fail(fmt::format("'{}' is not 0 or 1", word));
    }
    value = word == "1";
    return {};
}

Result<> name(std::string_view word, std::string &value) {
    if (word.size() > MAX_NAME) {
        return fail(fmt::format("it is longer than {} bytes", MAX_NAME));
    }
    value = word;
    return {};
}

Result<> path(std::string_view word, std::string &value) {
    value = word;
    return word.empty() ? fail("the name of a file is missing") : Result<>{};
}

Result<> port(std::string_view word, std::optional<int> &value) {
    int number = 0;
    const auto status = whole_number(word, 1, MAX_PORT, number);
    value = status.has_value() ? std::optional(number) : std::nullopt;
    return status;
}

Result<> timeout(std::string_view word, Timeout &value) {
    if (equals_ignoring_case(word, "INF")) {
        value = FOREVER;
        return {};
    }
    const auto number = parse_double(word);
    if (!number.has_value()) {
        return fail(fmt::format("'{}' is neither a number of seconds nor INF", word));
    }
    value.seconds = *number;
    return {};
}

constexpr std::array KINDS{Choice{"SHMEM", BufferKind::SHMEM}, Choice{"LOCMEM", BufferKind::LOCMEM},
                           Choice{"FILEMEM", BufferKind::FILEMEM}, Choice{"PHANTOM", BufferKind::PHANTOM},
                           Choice{"GLOBMEM", BufferKind::GLOBMEM}};
/// The manual writes the last one as two words, "mao split".
constexpr std::array MUTEXES{Choice{"os_sem", Mutex::OS_SEM}, Choice{"none", Mutex::NONE},
                             Choice{"no_interrupts", Mutex::NO_INTERRUPTS},
                             Choice{"no_switching", Mutex::NO_SWITCHING}, Choice{"mao", Mutex::MAO}};
constexpr std::array PLACES{Choice{"LOCAL", false}, Choice{"REMOTE", true}};

using B = BufferSettings;
using P = ProcessSettings;
using Value = LineOption<B>::Value;

constexpr std::array BUFFER_FIELDS{
    LineField<B>{"name",
                 [](std::string_view word, B &line) {
                     return word == DEFAULT_BUFFER ? fail("no buffer may be called so")
                                                   : name(word, line.name);
                 }},
    LineField<B>{"type", [](std::string_view word, B &line) { return choose(word, KINDS, line.kind); }},
    LineField<B>{"host", [](std::string_view word, B &line) { return name(word, line.host); }},
    LineField<B>{"size",
                 [](std::string_view word, B &line) { return whole_number(word, 1, MAX_SIZE, line.size); }},
    LineField<B>{"neut", [](std::string_view word, B &line) { return yes_or_no(word, line.neutral); }},
    // Only a placeholder: old files contain different values here.
    LineField<B>{"RPC#",
                 [](std::string_view word, B &line) {
                     return whole_number(word, -MAX_NUMBER, MAX_NUMBER, line.rpc_number);
                 }},
    LineField<B>{"buffer#", [](std::string_view word,
                               B &line) { return whole_number(word, 0, MAX_NUMBER, line.buffer_number); }},
    LineField<B>{"max_procs",
                 [](std::string_view word, B &line) {
                     return whole_number(word, 1, MAX_PROCESSES, line.max_processes);
                 }},
    LineField<B>{"key",
                 [](std::string_view word, B &line) { return whole_number(word, 0, MAX_NUMBER, line.key); }},
};

constexpr std::array PROCESS_FIELDS{
    LineField<P>{"name", [](std::string_view word, P &line) { return name(word, line.name); }},
    LineField<P>{"buffer", [](std::string_view word, P &line) { return name(word, line.buffer); }},
    LineField<P>{"type", [](std::string_view word, P &line) { return choose(word, PLACES, line.isRemote); }},
    LineField<P>{"host", [](std::string_view word, P &line) { return name(word, line.host); }},
    LineField<P>{"ops",
                 [](std::string_view word, P &line) -> Result<> {
                     const std::string ops = to_upper(word);
                     line.mayRead = ops == "R" || ops == "RW";
                     line.mayWrite = ops == "W" || ops == "RW";
                     return line.mayRead || line.mayWrite
                                ? Result<>{}
                                : fail(fmt::format("'{}' is not one of R, W, RW", word));
                 }},
    LineField<P>{"server", [](std::string_view word, P &line) { return yes_or_no(word, line.is_server); }},
    LineField<P>{"timeout", [](std::string_view word, P &line) { return timeout(word, line.timeout); }},
    LineField<P>{"master", [](std::string_view word, P &line) { return yes_or_no(word, line.isMaster); }},
    LineField<P>{"c_num",
                 [](std::string_view word, P &line) {
                     return whole_number(word, 0, MAX_PROCESSES - 1, line.connection_number);
                 }},
};

Result<> encode_as(Encoding encoding, B &line) {
    if (line.encoding.has_value() && line.encoding != encoding) {
        return fail(fmt::format("the buffer is {} already", name_of(*line.encoding)));
    }
    line.encoding = encoding;
    return {};
}

/// Without a value it means two copies.
Result<> split(std::string_view value, B &line) {
    return value.empty() ? Result<>{} : whole_number(value, 2, MAX_COPIES, line.copies);
}

constexpr std::array BUFFER_OPTIONS{
    LineOption<B>{"mutex", Value::NEEDED,
                  [](std::string_view value, B &line) { return choose(value, MUTEXES, line.mutex); }},
    LineOption<B>{"split", Value::ALLOWED, split},
    LineOption<B>{"TCP", Value::NEEDED,
                  [](std::string_view value, B &line) { return port(value, line.tcp_port); }},
    LineOption<B>{"UDP", Value::NEEDED,
                  [](std::string_view value, B &line) { return port(value, line.udp_port); }},
    LineOption<B>{"STCP", Value::NEEDED,
                  [](std::string_view value, B &line) { return port(value, line.stcp_port); }},
    LineOption<B>{"serialPortDevName", Value::NEEDED,
                  [](std::string_view value, B &line) { return path(value, line.serial_device); }},
    LineOption<B>{"passwd", Value::NEEDED,
                  [](std::string_view value, B &line) { return path(value, line.password_file); }},
    LineOption<B>{"bsem", Value::NEEDED,
                  [](std::string_view value, B &line) {
                      std::int64_t key = 0;
                      const auto status = whole_number(value, -1, MAX_NUMBER, key);
                      line.blocking_key = key;
                      return status;
                  }},
    LineOption<B>{"queue", Value::NONE,
                  [](std::string_view, B &line) {
                      line.is_queue = true;
                      return Result<>{};
                  }},
    LineOption<B>{"ascii", Value::NONE,
                  [](std::string_view, B &line) { return encode_as(Encoding::ASCII, line); }},
    LineOption<B>{"disp", Value::NONE,
                  [](std::string_view, B &line) { return encode_as(Encoding::DISPLAY, line); }},
    LineOption<B>{"xdr", Value::NONE,
                  [](std::string_view, B &line) { return encode_as(Encoding::XDR, line); }},
    LineOption<B>{"diag", Value::NONE,
                  [](std::string_view, B &line) {
                      line.diagnosed = true;
                      return Result<>{};
                  }},
    LineOption<B>{"confirm_write", Value::NONE,
                  [](std::string_view, B &line) {
                      line.write_confirmed = true;
                      return Result<>{};
                  }},
    LineOption<B>{"serial", Value::NONE,
                  [](std::string_view, B &line) {
                      line.isNumbered = true;
                      return Result<>{};
                  }},
    LineOption<B>{"file", Value::NEEDED,
                  [](std::string_view value, B &line) { return path(value, line.file); }},
};

const LineOption<B> *find_option(std::string_view name) {
    const auto found =
        std::find_if(BUFFER_OPTIONS.begin(), BUFFER_OPTIONS.end(),
                     [name](const LineOption<B> &option) { return equals_ignoring_case(name, option.name); });
    return found == BUFFER_OPTIONS.end() ? nullptr : &*found;
}

}  // namespace

const LineForm<BufferSettings> &buffer_form() {
    static constexpr LineForm<B> FORM{"B", BUFFER_FIELDS, BUFFER_OPTIONS};
    return FORM;
}

const LineForm<ProcessSettings> &process_form() {
    static constexpr LineForm<P> FORM{"P", PROCESS_FIELDS, {}};
    return FORM;
}

bool read_option(const Word &word, const LineForm<BufferSettings> &form, BufferSettings &buffer,
                 diagnostics::Sink &sink) {
    const std::size_t equals = word.text.find('=');
    const std::string_view name = word.text.substr(0, equals);
    const bool hasValue = equals != std::string_view::npos;
    const std::string_view value = hasValue ? word.text.substr(equals + 1) : "";
    const LineOption<B> *option = find_option(name);
    if (option == nullptr) {
        std::vector<std::string> names;
        std::transform(form.options.begin(), form.options.end(), std::back_inserter(names),
                       [](const LineOption<B> &known) { return known.name; });
        const std::string nearest = nearest_name(name, names);
        sink.warning(fmt::format("option '{}' is unknown and does nothing", name), word.place,
                     nearest.empty() ? "" : fmt::format("did you mean '{}'?", nearest));
        return true;
    }
    if (hasValue ? option->value == Value::NONE : option->value == Value::NEEDED) {
        sink.error(fmt::format("option '{}' {}", option->name,
                               hasValue ? "has no value" : "needs a value: NAME=VALUE"),
                   word.place);
        return false;
    }
    const auto status = option->read(value, buffer);
    if (!status.has_value()) {
        sink.error(fmt::format("option '{}': {}", option->name, status.error().message), word.place);
        return false;
    }
    return true;
}

bool read_option(const Word &word, const LineForm<ProcessSettings> &, ProcessSettings &process,
                 diagnostics::Sink &sink) {
    const std::string_view name = word.text.substr(0, word.text.find('='));
    sink.warning(fmt::format("option '{}' {} and does nothing", name,
                             find_option(name) == nullptr ? "is unknown" : "belongs to the line of a buffer"),
                 word.place, fmt::format("see the line of buffer '{}'", process.buffer));
    return true;
}

}  // namespace mw::nml
