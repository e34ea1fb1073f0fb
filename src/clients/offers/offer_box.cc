// SPDX-License-Identifier: GPL-2.0-or-later
#include "clients/offers/offer_box.hh"

#include <fcntl.h>
#include <poll.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "base/atomic_file.hh"
#include "base/temporary_file.hh"
#include "base/text.hh"
#include "clients/offers/json_fields.hh"

namespace mw::offers {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t MOST_INDEX_BYTES = std::size_t{64} << 20U;
constexpr std::int64_t LAST_TIME_MS = 253'402'214'400'000;
/// Maximum wait for another process that uses the folder.
constexpr int LOCK_TRIES = 200, LOCK_PAUSE_MS = 10;

/// Holds a lock file (flock), which ends with its process.
class FolderLock {
  public:
    static Result<FolderLock> take(const std::string &folder) {
        const std::string path = folder + "/lock";
        const int fd = ::open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW, 0600);
        if (fd < 0) {
            return fail(fmt::format("cannot open {}: {}", path, std::strerror(errno)));
        }
        FolderLock lock(fd);
        for (int i = 0; i < LOCK_TRIES; ++i) {
            if (::flock(fd, LOCK_EX | LOCK_NB) == 0) {
                return lock;
            }
            ::poll(nullptr, 0, LOCK_PAUSE_MS);
        }
        return fail(fmt::format("another process uses {}", folder));
    }
    FolderLock(FolderLock &&other) noexcept : fd_(std::exchange(other.fd_, -1)) {}
    FolderLock &operator=(FolderLock &&) = delete;
    ~FolderLock() {
        if (fd_ >= 0) {
            ::close(fd_);
        }
    }

  private:
    explicit FolderLock(int fd) : fd_(fd) {}
    int fd_;
};

nlohmann::json json_of(const Entry &entry) {
    const Standing &now = entry.standing;
    return {{"id", now.id},
            {"name", entry.name},
            {"from", entry.from},
            {"note", entry.note},
            {"sha256", entry.sha256},
            {"parts", entry.parts},
            {"bytes", entry.bytes},
            {"files", entry.files},
            {"received", entry.received},
            {"state", name_of(now.state)},
            {"at", now.at},
            {"by", now.by},
            {"reason", now.reason},
            {"noted", name_of(entry.noted)},
            {"job", entry.isJob}};
}

State read_state(Fields &fields, const char *name) {
    const std::string text = fields.text(name);
    const auto state = state_of(text);
    if (!state.has_value()) {
        fields.set_problem(fmt::format("the state {} is unknown", printable(text)));
    }
    return state.value_or(State::SENT);
}

Entry read_entry(Fields &fields) {
    Entry entry{.name = fields.text("name"),
                .from = fields.text("from"),
                .note = fields.text("note"),
                .sha256 = fields.text("sha256"),
                .parts = static_cast<int>(fields.whole("parts", 0, MOST_PARTS)),
                .bytes = static_cast<std::uint64_t>(fields.whole("bytes", 0, MOST_TEXT_BYTES)),
                .files = {},
                .received = static_cast<TimeMs>(fields.whole("received", 0, LAST_TIME_MS)),
                .standing = {.id = fields.text("id"),
                             .state = read_state(fields, "state"),
                             .at = static_cast<TimeMs>(fields.whole("at", 0, LAST_TIME_MS)),
                             .by = fields.text("by"),
                             .reason = fields.text("reason")},
                .noted = read_state(fields, "noted"),
                .isJob = fields.boolean("job")};
    for (const nlohmann::json &file : fields.list("files", MOST_FILES)) {
        if (!file.is_string()) {
            fields.set_problem("a file has no name");
            break;
        }
        entry.files.push_back(file.get<std::string>());
    }
    if (!isOfferId(entry.standing.id)) {
        fields.set_problem("\"id\" is not the id of an offer");
    }
    return entry;
}

Entry *find(std::vector<Entry> &entries, const std::string &id) {
    const auto found = std::ranges::find(entries, id, [](const Entry &one) { return one.standing.id; });
    return found == entries.end() ? nullptr : &*found;
}

bool isOpen(const Entry &entry) {
    return entry.standing.state == State::RECEIVED;
}

/// The entry of an offer that waits.
Result<Entry *> find_open(std::vector<Entry> &entries, const std::string &id) {
    Entry *const entry = find(entries, id);
    if (entry == nullptr) {
        return fail("There is no such offer.");
    }
    return isOpen(*entry) ? Result<Entry *>(entry)
                          : fail(fmt::format("The offer {} is {} already.", entry->name,
                                             name_of(entry->standing.state)));
}

/// Forgets the oldest ended offers.
void prune(std::vector<Entry> &entries) {
    const auto isEnded = [](const Entry &one) {
        return isFinal(one.standing.state) && one.isNoted() && !one.isJob;
    };
    auto surplus =
        std::ranges::count_if(entries, isEnded) - static_cast<std::ptrdiff_t>(OfferBox::MOST_ENDED);
    std::erase_if(entries, [&](const Entry &one) { return isEnded(one) && surplus-- > 0; });
}

}  // namespace

Result<OfferBox> OfferBox::open(const std::string &folder) {
    std::error_code error;
    fs::create_directories(folder, error);
    if (error) {
        return fail(fmt::format("cannot create {}: {}", folder, error.message()));
    }
    fs::permissions(folder, fs::perms::owner_all, error);
    OfferBox box(folder);
    const auto lock = FolderLock::take(folder);
    if (!lock.has_value()) {
        return std::unexpected(lock.error());
    }
    remove_dead_temporary_files(folder);
    const auto entries = box.load();
    if (!entries.has_value()) {
        return std::unexpected(entries.error());
    }
    box.tidy(*entries);
    return box;
}

/// Removes texts of offers that do not wait.
void OfferBox::tidy(const std::vector<Entry> &entries) const {
    std::vector<std::string> unused;
    std::error_code error;
    for (fs::directory_iterator at(folder_, error); !error && at != fs::directory_iterator();
         at.increment(error)) {
        const fs::path &path = at->path();
        const std::string id = path.stem().string();
        const bool isNeeded = std::ranges::any_of(
            entries, [&id](const Entry &one) { return one.standing.id == id && isOpen(one); });
        if (path.extension() == ".json" && isOfferId(id) && !isNeeded) {
            unused.push_back(path.string());
        }
    }
    for (const std::string &path : unused) {
        ::unlink(path.c_str());
    }
}

Result<std::vector<Entry>> OfferBox::load() const {
    if (::access(index_file().c_str(), F_OK) != 0 && errno == ENOENT) {
        return std::vector<Entry>{};
    }
    const auto text = read_file(index_file(), MOST_INDEX_BYTES);
    if (!text.has_value()) {
        return std::unexpected(text.error());
    }
    const auto document = nlohmann::json::parse(*text, nullptr, false);
    Fields fields(document);
    std::vector<Entry> entries;
    for (const nlohmann::json &one : fields.list("offers", MOST_ENDED * 10)) {
        Fields entry(one);
        entries.push_back(read_entry(entry));
        fields.take_problem(entry);
    }
    return fields.problem().empty() ? Result<std::vector<Entry>>(std::move(entries))
                                    : fail(fmt::format("{} is damaged: {}", index_file(), fields.problem()),
                                           {}, "remove it: offers that wait are received again");
}

Result<> OfferBox::save(const std::vector<Entry> &entries) const {
    auto list = nlohmann::json::array();
    for (const Entry &one : entries) {
        list.push_back(json_of(one));
    }
    return write_file_atomically(index_file(), nlohmann::json{{"offers", std::move(list)}}.dump(1) + '\n');
}

Result<> OfferBox::change(const Change &act) {
    const auto lock = FolderLock::take(folder_);
    if (!lock.has_value()) {
        return std::unexpected(lock.error());
    }
    auto entries = load();
    if (!entries.has_value()) {
        return std::unexpected(entries.error());
    }
    const std::vector<Entry> before = *entries;
    if (auto done = act(*entries); !done.has_value() || *entries == before) {
        return done;
    }
    prune(*entries);
    auto saved = save(*entries);
    if (saved.has_value()) {
        tidy(*entries);
    }
    return saved;
}

Result<> OfferBox::take(const Offer &offer, TimeMs now) {
    return change([&](std::vector<Entry> &entries) -> Result<> {
        if (const Entry *const known = find(entries, offer.id)) {
            const bool isSame = known->sha256.empty() || known->sha256 == offer.sha256;
            return isSame
                       ? Result<>{}
                       : fail(fmt::format("offer {} arrived again with other files; the first ones are kept",
                                          offer.id));
        }
        if (static_cast<std::size_t>(std::ranges::count_if(entries, isOpen)) >= MOST_OPEN) {
            return fail(fmt::format("{} offers wait for the operator; no other one is received", MOST_OPEN));
        }
        if (auto written = write_file_atomically(text_file(offer.id), encode(offer)); !written.has_value()) {
            return written;
        }
        Entry entry{
            .name = offer.name(),
            .from = offer.from,
            .note = offer.note,
            .sha256 = offer.sha256,
            .parts = offer.parts,
            .bytes = offer.bytes(),
            .files = {},
            .received = now,
            .standing = {.id = offer.id, .state = State::RECEIVED, .at = now, .by = {}, .reason = {}}};
        for (const OfferedFile &file : offer.files) {
            entry.files.push_back(file.name);
        }
        entries.push_back(std::move(entry));
        return {};
    });
}

Result<> OfferBox::reject(const BrokenOffer &broken, TimeMs now) {
    return change([&](std::vector<Entry> &entries) -> Result<> {
        if (find(entries, broken.id) == nullptr) {
            Entry entry;
            entry.received = now;
            entry.standing = {broken.id, State::REJECTED, now, "", broken.why.substr(0, MOST_NOTE_BYTES)};
            entries.push_back(std::move(entry));
        }
        return {};
    });
}

Result<> OfferBox::withdraw(const std::vector<std::string> &ids, TimeMs now) {
    return change([&](std::vector<Entry> &entries) -> Result<> {
        for (const std::string &id : ids) {
            Entry *entry = find(entries, id);
            if (entry == nullptr) {
                entries.push_back({.received = now, .standing = {.id = id, .state = State::RECEIVED}});
                entry = &entries.back();
            }
            if (isOpen(*entry)) {
                entry->standing = {.id = id, .state = State::WITHDRAWN, .at = now, .by = {}, .reason = {}};
            } else {
                entry->noted = State::SENT;  // the shop does not know the final state yet
            }
        }
        return {};
    });
}

Result<> OfferBox::note(const std::vector<Note> &notes) {
    return change([&](std::vector<Entry> &entries) -> Result<> {
        for (const Note &one : notes) {
            if (Entry *const entry = find(entries, one.id); entry != nullptr) {
                entry->noted = one.state;
            }
        }
        return {};
    });
}

Result<> OfferBox::accept(const std::string &id, const std::string &by, TimeMs now,
                          const std::function<Result<>(const Offer &)> &put) {
    return change([&](std::vector<Entry> &entries) -> Result<> {
        const auto entry = find_open(entries, id);
        if (!entry.has_value()) {
            return std::unexpected(entry.error());
        }
        const auto offer = read(id);
        if (!offer.has_value()) {
            return std::unexpected(offer.error());
        }
        if (auto written = put(*offer); !written.has_value()) {
            return written;
        }
        (*entry)->standing = {.id = id, .state = State::ACCEPTED, .at = now, .by = by, .reason = {}};
        (*entry)->isJob = (*entry)->parts > 0;
        return {};
    });
}

Result<> OfferBox::decline(const std::string &id, const std::string &by, const std::string &reason,
                           TimeMs now) {
    if (reason.size() > MOST_NOTE_BYTES || !isPlainText(reason)) {
        return fail(fmt::format("The reason is longer than {} bytes or has line breaks.", MOST_NOTE_BYTES));
    }
    return change([&](std::vector<Entry> &entries) -> Result<> {
        const auto entry = find_open(entries, id);
        if (!entry.has_value()) {
            return std::unexpected(entry.error());
        }
        (*entry)->standing = {.id = id, .state = State::DECLINED, .at = now, .by = by, .reason = reason};
        return {};
    });
}

Result<> OfferBox::finish(const std::string &id) {
    return change([&](std::vector<Entry> &entries) -> Result<> {
        Entry *const entry = find(entries, id);
        if (entry == nullptr || !entry->isJob) {
            return fail(fmt::format("There is no job of the offer {}.", id));
        }
        entry->isJob = false;
        return {};
    });
}

Result<std::vector<Entry>> OfferBox::entries() const {
    return load();  // the index is replaced atomically
}

Result<Offer> OfferBox::read(const std::string &id) const {
    if (!isOfferId(id)) {
        return fail("This is not the id of an offer.");
    }
    const auto text = read_file(text_file(id), MOST_MESSAGE_BYTES);
    if (!text.has_value()) {
        return std::unexpected(text.error());
    }
    auto offer = decode_offer(*text);
    return offer.has_value() && offer->id == id
               ? offer
               : fail(fmt::format("{} is damaged: {}", text_file(id),
                                  offer.has_value() ? "it has another id" : offer.error().message));
}

std::uint64_t OfferBox::version() const {
    struct stat facts{};
    if (::stat(index_file().c_str(), &facts) != 0) {
        return 0;
    }
    constexpr std::uint64_t NS_PER_S = 1'000'000'000, MIX = 0x9E3779B97F4A7C15;
    return (static_cast<std::uint64_t>(facts.st_mtim.tv_sec) * NS_PER_S +
            static_cast<std::uint64_t>(facts.st_mtim.tv_nsec)) ^
           (facts.st_ino * MIX);
}

Report report_of(const std::vector<Entry> &entries) {
    Report report;
    for (const Entry &one : entries) {
        if (isOpen(one)) {
            report.open.push_back(one.standing.id);
        }
        if (!one.isNoted() && report.changes.size() < MOST_ENTRIES) {
            report.changes.push_back(one.standing);
        }
    }
    report.hasRoom = report.open.size() < OfferBox::MOST_OPEN;
    return report;
}

}  // namespace mw::offers
