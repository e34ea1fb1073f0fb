// SPDX-License-Identifier: GPL-2.0-or-later
#include "machine/journal/records.hh"

#include <array>

#include "base/bytes.hh"

namespace mw::journal {
namespace {

/// The last byte is the version of the format.
constexpr std::string_view MAGIC = "MWJRNL\n\x01";
/// A longer record is not valid, because its length was only partly written.
constexpr std::uint32_t MOST_BYTES = 64U << 20U;

enum class Kind : std::uint8_t { START, PROGRESS, DOUBT, END };

constexpr std::uint64_t POLYNOMIAL = 0xC96C5795D7870F42;  // ECMA-182, reflected

constexpr std::array<std::uint64_t, 256> TABLE = [] {
    constexpr int BITS = 8;
    std::array<std::uint64_t, 256> table{};
    for (std::uint64_t i = 0; i < table.size(); ++i) {
        std::uint64_t sum = i;
        for (int bit = 0; bit < BITS; ++bit) {
            sum = (sum >> 1U) ^ ((sum & 1U) != 0 ? POLYNOMIAL : 0);
        }
        table[i] = sum;
    }
    return table;
}();

std::uint64_t sum_of(std::string_view bytes) {
    constexpr unsigned BITS = 8;
    constexpr std::uint64_t BYTE = 0xff;
    std::uint64_t sum = ~std::uint64_t{0};
    for (const char c : bytes) {
        sum = TABLE[(sum ^ static_cast<unsigned char>(c)) & BYTE] ^ (sum >> BITS);
    }
    return ~sum;
}

template <class Io, class AnyStart>
void fields(Io &io, AnyStart &start, Start *) {
    io(start.id);
    io(start.program);
    io(start.file.bytes);
    io(start.file.sum);
    io(start.state);
}

template <class Io, class AnyProgress>
void fields(Io &io, AnyProgress &progress, Progress *) {
    io(progress.block);
    io(progress.line);
    io(progress.calls);
    for (int axis = 0; axis < geometry::AXIS_COUNT; ++axis) {
        io(progress.position[axis]);
    }
    io(progress.tool);
    io(progress.tools);
}

template <class Io, class AnyDoubt>
void fields(Io &io, AnyDoubt &doubt, Doubt *) {
    io(doubt.block);
    io(doubt.line);
    io(doubt.what);
}

/// Length, checksum, type, fields; the checksum covers everything after it.
std::string frame(std::uint64_t key, Kind kind, const std::string &fields) {
    const std::string body = std::string(1, static_cast<char>(kind)) + fields;
    Packer head;
    head(static_cast<std::uint32_t>(body.size()));
    head(key ^ sum_of(body));
    return head.bytes() + body;
}

template <class T>
std::string packed(std::uint64_t key, Kind kind, const T &value) {
    Packer out;
    fields(out, value, static_cast<T *>(nullptr));
    return frame(key, kind, out.bytes());
}

/// The next complete record; nothing at the end and before an incomplete record.
std::optional<std::string_view> next_record(std::string_view &rest, std::uint64_t key) {
    constexpr std::size_t HEAD = sizeof(std::uint32_t) + sizeof(std::uint64_t);
    std::uint32_t size = 0;
    std::uint64_t sum = 0;
    Unpacker head(rest);
    head(size);
    head(sum);
    if (!head.isGood() || size == 0 || size > MOST_BYTES || size > head.left()) {
        return std::nullopt;
    }
    const std::string_view body = rest.substr(HEAD, size);
    if ((key ^ sum_of(body)) != sum) {
        return std::nullopt;
    }
    rest.remove_prefix(HEAD + size);
    return body;
}

template <class T>
bool unpack(std::string_view body, T &value) {
    Unpacker in(body.substr(1));
    fields(in, value, static_cast<T *>(nullptr));
    return in.isComplete();
}

/// Reads a record. False if this version does not write such records.
bool take(std::string_view body, Run &run) {
    Progress progress;
    Doubt doubt;
    switch (static_cast<Kind>(body[0])) {
    case Kind::START: return false;  // allowed only at the beginning
    case Kind::PROGRESS:
        if (!unpack(body, progress)) {
            return false;
        }
        run.progress = progress;
        return true;
    case Kind::DOUBT:
        if (!unpack(body, doubt)) {
            return false;
        }
        run.doubt = run.doubt.has_value() ? run.doubt : doubt;
        return true;
    case Kind::END: run.ended = true; return body.size() == 1;
    }
    return false;
}

}  // namespace

FileMark mark_of(std::string_view content) {
    return {content.size(), sum_of(content)};
}

std::string begin_bytes(const Start &start) {
    return std::string(MAGIC) + packed(0, Kind::START, start);
}

std::uint64_t key_of(const Start &start) {
    Packer out;
    fields(out, start, static_cast<Start *>(nullptr));
    return sum_of(out.bytes());
}

std::string record(std::uint64_t key, const Progress &progress) {
    return packed(key, Kind::PROGRESS, progress);
}

std::string record(std::uint64_t key, const Doubt &doubt) {
    return packed(key, Kind::DOUBT, doubt);
}

std::string end_record(std::uint64_t key) {
    return frame(key, Kind::END, {});
}

Result<Run> read_run(std::string_view bytes) {
    if (!bytes.starts_with(MAGIC)) {
        return fail("the file is not a journal, or has another version");
    }
    bytes.remove_prefix(MAGIC.size());
    Run run;
    const auto first = next_record(bytes, 0);
    if (!first.has_value() || static_cast<Kind>((*first)[0]) != Kind::START || !unpack(*first, run.start)) {
        return fail("the beginning of the journal is damaged");
    }
    const std::uint64_t key = key_of(run.start);
    while (const auto body = next_record(bytes, key)) {
        if (!take(*body, run)) {
            return fail("the journal has a record that this version does not know");
        }
    }
    return run;
}

}  // namespace mw::journal
