// SPDX-License-Identifier: GPL-2.0-or-later
// Implemented with libcurl, which only this file includes.
#include "clients/shop/notify/notifier.hh"

#include <curl/curl.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdint>
#include <cstring>
#include <ctime>
#include <memory>
#include <nlohmann/json.hpp>
#include <string_view>
#include <utility>

#include <fmt/chrono.h>
#include <fmt/format.h>

#include "base/text.hh"
#include "clients/publish/value.hh"

namespace mw::shop {
namespace {

constexpr const char *MAIL = "mail";
constexpr double PERIOD_S = 2, RETRY_S = 30;
constexpr long TIMEOUT_S = 20;

struct Library {
    Library() { curl_global_init(CURL_GLOBAL_DEFAULT); }
    ~Library() { curl_global_cleanup(); }
    Library(const Library &) = delete;
    Library &operator=(const Library &) = delete;
};

struct EndList {
    void operator()(curl_slist *list) const { curl_slist_free_all(list); }
};
using List = std::unique_ptr<curl_slist, EndList>;

List list_of(const std::vector<std::string> &words) {
    curl_slist *list = nullptr;
    for (const std::string &word : words) {
        list = curl_slist_append(list, word.c_str());
    }
    return List(list);
}

std::string base64(std::string_view bytes) {
    constexpr std::string_view DIGITS = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    constexpr unsigned DIGIT = 63;
    std::string text;
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        std::uint32_t group = 0;
        for (std::size_t j = 0; j < 3; ++j) {
            const bool isThere = i + j < bytes.size();
            group = (group << 8U) | (isThere ? static_cast<unsigned char>(bytes[i + j]) : 0U);
        }
        const std::size_t digits = std::min<std::size_t>(bytes.size() - i, 3) + 1;
        for (std::size_t j = 0; j < 4; ++j) {
            text += j < digits ? DIGITS[(group >> (18U - 6U * j)) & DIGIT] : '=';
        }
    }
    return text;
}

/// Text of the header Subject: encoded words of RFC 2047 with whole characters, one per line of at most 76
/// bytes.
std::string encoded_words(std::string_view text) {
    constexpr std::size_t MOST = 39;  // 39 bytes are 52 digits
    std::string words;
    do {
        std::size_t end = std::min(MOST, text.size());
        const auto isInCharacter = [&text](std::size_t at) {
            return at < text.size() && (static_cast<unsigned char>(text[at]) & 0xC0U) == 0x80U;
        };
        while (end > 0 && isInCharacter(end)) {
            --end;
        }
        words += fmt::format("{}=?UTF-8?B?{}?=", words.empty() ? "" : "\r\n ", base64(text.substr(0, end)));
        text.remove_prefix(end);
    } while (!text.empty());
    return words;
}

/// Lines of 76 digits, as in RFC 2045.
std::string base64_lines(std::string_view bytes) {
    constexpr std::size_t LINE = 57;
    std::string lines;
    for (; !bytes.empty(); bytes.remove_prefix(std::min(LINE, bytes.size()))) {
        lines += base64(bytes.substr(0, LINE)) + "\r\n";
    }
    return lines;
}

std::string duration(std::int64_t seconds) {
    constexpr std::int64_t MINUTE = 60, HOUR = 3600;
    return seconds < HOUR ? fmt::format("{} min", seconds / MINUTE)
                          : fmt::format("{} h {} min", seconds / HOUR, seconds % HOUR / MINUTE);
}

/// Date in the format of RFC 5322.
std::string date_now() {
    return fmt::format("{:%a, %d %b %Y %H:%M:%S} +0000", fmt::gmtime(std::time(nullptr)));
}

struct Upload {
    std::string_view rest;

    static std::size_t read(char *to, std::size_t size, std::size_t count, void *from) {
        auto &upload = *static_cast<Upload *>(from);
        const std::size_t bytes = std::min(size * count, upload.rest.size());
        std::memcpy(to, upload.rest.data(), bytes);
        upload.rest.remove_prefix(bytes);
        return bytes;
    }
};

std::size_t ignore(char *, std::size_t size, std::size_t count, void *) {
    return size * count;
}

Result<> perform(CURL *curl, std::string_view target) {
    std::array<char, CURL_ERROR_SIZE> text{};
    curl_easy_setopt(curl, CURLOPT_ERRORBUFFER, text.data());
    curl_easy_setopt(curl, CURLOPT_TIMEOUT, TIMEOUT_S);
    curl_easy_setopt(curl, CURLOPT_NOSIGNAL, 1L);
    curl_easy_setopt(curl, CURLOPT_WRITEFUNCTION, ignore);
    curl_easy_setopt(curl, CURLOPT_FAILONERROR, 1L);
    const CURLcode code = curl_easy_perform(curl);
    return code == CURLE_OK ? Result<>{}
                            : fail(fmt::format("cannot send a notification to {}: {}", target,
                                               text[0] != '\0' ? text.data() : curl_easy_strerror(code)));
}

using Curl = std::unique_ptr<CURL, decltype(&curl_easy_cleanup)>;

Result<> send_mail(const NotifierSettings &settings, const Notification &what) {
    const Curl curl(curl_easy_init(), &curl_easy_cleanup);
    const List receivers = list_of(settings.to);
    const std::string text = mail_text(settings, what, date_now());
    Upload upload{text};
    curl_easy_setopt(curl.get(), CURLOPT_URL, settings.server.c_str());
    curl_easy_setopt(curl.get(), CURLOPT_PROTOCOLS_STR, "smtp,smtps");
    curl_easy_setopt(curl.get(), CURLOPT_MAIL_FROM, settings.from.c_str());
    curl_easy_setopt(curl.get(), CURLOPT_MAIL_RCPT, receivers.get());
    curl_easy_setopt(curl.get(), CURLOPT_READFUNCTION, &Upload::read);
    curl_easy_setopt(curl.get(), CURLOPT_READDATA, &upload);
    curl_easy_setopt(curl.get(), CURLOPT_UPLOAD, 1L);
    // A password is never sent in clear text.
    curl_easy_setopt(curl.get(), CURLOPT_USE_SSL,
                     static_cast<long>(settings.user.empty() ? CURLUSESSL_TRY : CURLUSESSL_ALL));
    if (!settings.user.empty()) {
        curl_easy_setopt(curl.get(), CURLOPT_USERNAME, settings.user.c_str());
        curl_easy_setopt(curl.get(), CURLOPT_PASSWORD, settings.password.c_str());
    }
    return perform(curl.get(), settings.server);
}

Result<> send_webhook(const std::string &address, const Notification &what) {
    const Curl curl(curl_easy_init(), &curl_easy_cleanup);
    const List headers = list_of({"Content-Type: application/json", "Expect:"});
    const std::string text = webhook_text(what);
    curl_easy_setopt(curl.get(), CURLOPT_URL, address.c_str());
    curl_easy_setopt(curl.get(), CURLOPT_PROTOCOLS_STR, "http,https");
    curl_easy_setopt(curl.get(), CURLOPT_HTTPHEADER, headers.get());
    curl_easy_setopt(curl.get(), CURLOPT_POSTFIELDSIZE, static_cast<long>(text.size()));
    curl_easy_setopt(curl.get(), CURLOPT_POSTFIELDS, text.c_str());
    return perform(curl.get(), address);
}

}  // namespace

std::string mail_text(const NotifierSettings &settings, const Notification &what, const std::string &date) {
    // Without control characters no text can add a header or end the mail.
    const std::string subject = publish::clean_text(
        fmt::format("{}: {}{}", what.machine, what.late_s > LATE_S ? "Late: " : "", what.message));
    std::string receivers;
    for (const std::string &one : settings.to) {
        receivers += fmt::format("{}{}", receivers.empty() ? "" : ",\r\n ", one);
    }
    std::string body = fmt::format("{}\n{}\n{}\n{}\n", what.machine, what.source,
                                   publish::clean_text(what.message), what.at);
    if (what.late_s > LATE_S) {
        body += fmt::format("Late: the machine sent this {} after the event, received {}. {}\n",
                            duration(what.late_s), what.received,
                            what.isOver ? "The condition has ended." : "No later value was received.");
    }
    // The same notification has the same id, so a repeated mail can be recognised.
    const std::string domain =
        settings.from.substr(std::min(settings.from.find('@') + 1, settings.from.size()));
    return fmt::format("From: {}\r\nTo: {}\r\nSubject: {}\r\nDate: {}\r\nMessage-ID: <notification-{}@{}>\r\n"
                       "MIME-Version: 1.0\r\nContent-Type: text/plain; charset=utf-8\r\n"
                       "Content-Transfer-Encoding: base64\r\n\r\n{}",
                       settings.from, receivers, encoded_words(subject), date, what.id, domain,
                       base64_lines(body));
}

std::string webhook_text(const Notification &what) {
    return nlohmann::json{{"id", what.id},         {"machine", what.machine},
                          {"time", what.at},       {"received", what.received},
                          {"late_s", what.late_s}, {"over", what.isOver},
                          {"source", what.source}, {"message", what.message}}
        .dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

Notifier::Notifier(std::string database, NotifierSettings settings, Report report)
    : database_(std::move(database)), settings_(std::move(settings)), report_(std::move(report)) {
    static const Library LIBRARY;
    thread_ = std::thread([this] { run(); });
}

Notifier::~Notifier() {
    {
        const std::lock_guard lock(mutex_);
        isEnded_ = true;
    }
    change_.notify_all();
    thread_.join();
}

/// False at the end.
bool Notifier::wait(double seconds) {
    std::unique_lock lock(mutex_);
    return !change_.wait_for(lock, std::chrono::duration<double>(seconds), [this] { return isEnded_; });
}

Result<> Notifier::send(const std::string &target, const Notification &what) const {
    return target == MAIL ? send_mail(settings_, what) : send_webhook(target, what);
}

Result<> Notifier::send_to(Database &database, const std::string &target) {
    const std::array parameters{Parameter{target, false, false}};
    const auto rows = database.ask(
        "SELECT notification.id, machine.grp || '/' || machine.node || '/' || device, "
        "notification.at, source, message, received, extract(epoch FROM late)::bigint, "
        "is_over(notification) FROM notification JOIN machine ON machine.id = machine "
        "WHERE received > now() - interval '1 day' AND NOT EXISTS (SELECT FROM sent "
        "WHERE notification = notification.id AND target = $1) ORDER BY notification.id LIMIT 50",
        parameters);
    if (!rows.has_value()) {
        return std::unexpected(rows.error());
    }
    for (int i = 0; i < rows->count(); ++i) {
        const auto text = [&](int column) { return rows->text(i, column).value_or(""); };
        const auto done = send(target, {.id = text(0),
                                        .machine = text(1),
                                        .at = text(2),
                                        .source = text(3),
                                        .message = text(4),
                                        .received = text(5),
                                        .late_s = parse_int(text(6)).value_or(0),
                                        .isOver = text(7) == "t"});
        if (!done.has_value()) {
            return done;
        }
        const std::array note{Parameter{text(0), false, false}, Parameter{target, false, false}};
        const auto noted = database.ask(
            "INSERT INTO sent (notification, target) VALUES ($1, $2) ON CONFLICT DO NOTHING", note);
        if (!noted.has_value()) {
            return std::unexpected(noted.error());
        }
    }
    return {};
}

Result<> Notifier::send_all(Database &database) {
    std::vector<std::string> targets = settings_.webhooks;
    if (!settings_.to.empty()) {
        targets.emplace_back(MAIL);
    }
    Result<> all{};
    for (const std::string &target : targets) {
        // A target that fails does not delay the other targets.
        if (auto done = send_to(database, target); !done.has_value()) {
            all = std::move(done);
        }
    }
    return all;
}

void Notifier::run() {
    bool isRunning = true;
    while (isRunning) {
        auto database = Database::open(database_);
        // Only one collector of those that use the database sends.
        const auto taken =
            database.has_value()
                ? database->ask("SELECT pg_try_advisory_lock(hashtext('millwright shop notify'))")
                : Result<Rows>(std::unexpected(database.error()));
        const bool isOurs = taken.has_value() && taken->text(0, 0) == "t";
        double pause_s = PERIOD_S;
        while (isOurs && wait(pause_s)) {
            const auto done = send_all(*database);
            pause_s = done.has_value() ? PERIOD_S : RETRY_S;
            const std::string now = done.has_value() ? "" : done.error().message;
            if (now != std::exchange(trouble_, now) && !now.empty()) {
                report_(now + ".");
            }
            if (!done.has_value() && !database->run("SELECT").has_value()) {
                break;
            }
        }
        isRunning = wait(PERIOD_S);
    }
}

}  // namespace mw::shop
