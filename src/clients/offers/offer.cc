// SPDX-License-Identifier: GPL-2.0-or-later
#include "clients/offers/offer.hh"

#include <openssl/evp.h>

#include <algorithm>
#include <array>
#include <set>
#include <utility>

#include <fmt/format.h>

#include "base/text.hh"
#include "base/utf8.hh"
#include "clients/offers/json_fields.hh"

namespace mw::offers {
namespace {

constexpr std::array<std::string_view, 6> STATE_NAMES{"sent",     "received",  "accepted",
                                                      "declined", "withdrawn", "rejected"};
constexpr std::array<std::string_view, 5> EXTENSIONS{".ngc", ".nc", ".tap", ".cnc", ".gcode"};

bool isHex(char c) {
    return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'f');
}

/// Control characters other than tab and line breaks.
bool isControl(char32_t code) {
    const bool isBlank = code == '\t' || code == '\n' || code == '\r';
    return (code < 0x20U && !isBlank) || (code >= 0x7FU && code < 0xA0U);
}

/// Characters that change the direction of writing, with which a name could look like another one.
bool isDirection(char32_t code) {
    return code == 0x200EU || code == 0x200FU || (code >= 0x202AU && code <= 0x202EU) ||
           (code >= 0x2066U && code <= 0x2069U);
}

/// Position of the first character that is not valid UTF-8, or for which `isBad` is true; npos if there is
/// none.
std::size_t find_bad(std::string_view text, bool (*isBad)(char32_t)) {
    for (std::size_t at = 0; at < text.size();) {
        const Utf8Character one = first_character(text.substr(at));
        if (one.size == 0 || isBad(one.code)) {
            return at;
        }
        at += one.size;
    }
    return std::string_view::npos;
}

Result<> check_text(const OfferedFile &file) {
    const std::size_t bad = find_bad(file.text, isControl);
    if (bad == std::string_view::npos) {
        return {};
    }
    const auto line =
        1 + std::count(file.text.begin(), file.text.begin() + static_cast<std::ptrdiff_t>(bad), '\n');
    return fail(fmt::format("line {} of {} has a byte 0x{:02X}, which is not text in UTF-8", line, file.name,
                            static_cast<unsigned char>(file.text[bad])));
}

Result<> check_files(const std::vector<OfferedFile> &files) {
    if (files.empty() || files.size() > MOST_FILES) {
        return fail(fmt::format("an offer has 1 to {} files, not {}", MOST_FILES, files.size()));
    }
    std::set<std::string> names;
    std::size_t bytes = 0;
    for (const OfferedFile &file : files) {
        if (const std::string wrong = check_name(file.name); !wrong.empty()) {
            return fail(wrong);
        }
        if (!names.insert(to_lower(file.name)).second) {
            return fail(fmt::format("two files have the name {}", file.name));
        }
        bytes += file.text.size();
        if (auto text = check_text(file); !text.has_value()) {
            return text;
        }
    }
    if (bytes > MOST_TEXT_BYTES) {
        return fail(fmt::format("the files have {} bytes; the maximum is {}", bytes, MOST_TEXT_BYTES));
    }
    return {};
}

Result<> check_words(const Offer &offer) {
    if (!isOfferId(offer.id)) {
        return fail(fmt::format("'{}' is not the id of an offer", printable(offer.id.substr(0, 40))));
    }
    if (offer.from.empty() || offer.from.size() > MOST_PERSON_BYTES || !isPlainText(offer.from)) {
        return fail(fmt::format("the name of the sender needs 1 to {} bytes without control characters",
                                MOST_PERSON_BYTES));
    }
    if (offer.note.size() > MOST_NOTE_BYTES || find_bad(offer.note, isControl) != std::string::npos) {
        return fail(
            fmt::format("the note is longer than {} bytes or has control characters", MOST_NOTE_BYTES));
    }
    if (offer.parts < 0 || offer.parts > MOST_PARTS) {
        return fail(fmt::format("the number of parts is {}; it must be 0 to {}", offer.parts, MOST_PARTS));
    }
    return {};
}

}  // namespace

std::uint64_t Offer::bytes() const {
    std::uint64_t sum = 0;
    for (const OfferedFile &file : files) {
        sum += file.text.size();
    }
    return sum;
}

std::string sha256_of_bytes(std::string_view bytes) {
    std::array<unsigned char, EVP_MAX_MD_SIZE> digest{};
    unsigned size = 0;
    EVP_Digest(bytes.data(), bytes.size(), digest.data(), &size, EVP_sha256(), nullptr);
    std::string text;
    for (unsigned i = 0; i < size; ++i) {
        text += fmt::format("{:02x}", digest[i]);
    }
    return text;
}

std::string sha256_of(const std::vector<OfferedFile> &files) {
    std::string bytes;
    for (const OfferedFile &file : files) {
        bytes += file.name + '\0' + std::to_string(file.text.size()) + '\0' + file.text;
    }
    return sha256_of_bytes(bytes);
}

bool isOfferId(std::string_view text) {
    constexpr std::string_view FORM = "xxxxxxxx-xxxx-xxxx-xxxx-xxxxxxxxxxxx";
    return text.size() == FORM.size() && std::ranges::equal(text, FORM, [](char c, char form) {
               return form == '-' ? c == '-' : isHex(c);
           });
}

bool isPlainText(std::string_view text) {
    return find_bad(text, isControl) == std::string_view::npos &&
           text.find_first_of("\t\r\n") == std::string_view::npos;
}

std::string check_name(std::string_view name) {
    if (name.empty() || name.size() > MOST_NAME_BYTES) {
        return fmt::format("the name of a file needs 1 to {} bytes", MOST_NAME_BYTES);
    }
    if (!isPlainText(name)) {
        return "the name of a file has control characters or is not UTF-8";
    }
    if (find_bad(name, isDirection) != std::string_view::npos) {
        return "the name of a file has characters that change the direction of writing";
    }
    if (name.front() == '.' || name.find_first_of("/\\") != std::string_view::npos) {
        return fmt::format("'{}' is not a plain file name: it has a folder or is hidden", name);
    }
    const std::string lower = to_lower(name);
    const bool isProgram = std::ranges::any_of(EXTENSIONS, [&lower](std::string_view one) {
        return lower.ends_with(one) && lower.size() > one.size();
    });
    return isProgram
               ? ""
               : fmt::format("'{}' is not a program: its name must end in .ngc, .nc, .tap, .cnc or .gcode",
                             name);
}

Result<> check(const Offer &offer) {
    if (auto words = check_words(offer); !words.has_value()) {
        return words;
    }
    if (auto files = check_files(offer.files); !files.has_value()) {
        return files;
    }
    return offer.sha256 == sha256_of(offer.files)
               ? Result<>{}
               : fail(fmt::format("the SHA-256 of {} does not fit its files", offer.name()));
}

std::string encode(const Offer &offer) {
    return json_of(offer).dump();
}

Result<Offer> decode_offer(std::string_view json) {
    if (json.size() > MOST_MESSAGE_BYTES) {
        return fail(
            fmt::format("the message has {} bytes; the maximum is {}", json.size(), MOST_MESSAGE_BYTES));
    }
    const auto document = nlohmann::json::parse(json, nullptr, false);
    if (!document.is_object()) {
        return fail("the offer is not a JSON object in UTF-8");
    }
    return offer_of(document);
}

Result<Offer> offer_of(const nlohmann::json &object) {
    Fields fields(object);
    Offer offer{.id = fields.text("id"),
                .from = fields.text("from"),
                .note = fields.text("note"),
                .parts = static_cast<int>(fields.whole("parts", -1, MOST_PARTS)),
                .sha256 = fields.text("sha256"),
                .files = {}};
    for (const nlohmann::json &one : fields.list("files", MOST_FILES)) {
        Fields file(one);
        offer.files.push_back({file.text("name"), file.text("text")});
        fields.take_problem(file);
    }
    if (!fields.problem().empty()) {
        return fail(fields.problem());
    }
    const auto checked = check(offer);
    return checked.has_value() ? Result<Offer>(std::move(offer)) : std::unexpected(checked.error());
}

nlohmann::json json_of(const Offer &offer) {
    auto files = nlohmann::json::array();
    for (const OfferedFile &file : offer.files) {
        files.push_back({{"name", file.name}, {"text", file.text}});
    }
    return {{"id", offer.id},       {"from", offer.from},     {"note", offer.note},
            {"parts", offer.parts}, {"sha256", offer.sha256}, {"files", std::move(files)}};
}

std::string_view name_of(State state) {
    return STATE_NAMES[static_cast<std::size_t>(state)];
}

std::optional<State> state_of(std::string_view name) {
    const auto *const found = std::ranges::find(STATE_NAMES, name);
    return found == STATE_NAMES.end() ? std::nullopt
                                      : std::optional(static_cast<State>(found - STATE_NAMES.begin()));
}

}  // namespace mw::offers
