// SPDX-License-Identifier: GPL-2.0-or-later
#include "runtime/log.hh"

#include <chrono>
#include <cstdio>
#include <cstring>
#include <mutex>
#include <thread>

#include "runtime/format.hh"

namespace mw::runtime {
namespace {

/// Records are in the order of the writers' tickets. For ticket t, `turn` is t while a writer may fill the
/// slot, t+1 when it is filled, t+RECORDS once it has been printed.
struct Record {
    std::atomic<std::uint64_t> turn{0};
    LogLevel level = LogLevel::NONE;
    bool is_continued = false;  ///< the next text of level ALL belongs to the same line
    std::array<char, Log::TEXT_SIZE> text{};
};

void to_standard_files(void * /*context*/, LogLevel level, const char *text) {
    std::FILE *const file = level == LogLevel::ALL ? stdout : stderr;
    std::fprintf(file, "%s\n", text);
    std::fflush(file);
}

/// True if there was a newline.
bool trim_newline(char *text, std::size_t length) noexcept {
    const std::size_t whole = length;
    while (length > 0 && text[length - 1] == '\n') {
        text[--length] = '\0';
    }
    return length < whole;
}

void fill(Record &record, LogLevel level, const char *format, std::va_list args) noexcept {
    record.level = level;
    const int length = format_text(record.text.data(), Log::TEXT_SIZE, format, args);
    const std::size_t size = length < 0 ? 0 : static_cast<std::size_t>(length);
    if (size >= Log::TEXT_SIZE) {
        constexpr char MORE[] = "...";
        std::memcpy(record.text.data() + Log::TEXT_SIZE - sizeof MORE, MORE, sizeof MORE);
        record.is_continued = false;
        return;
    }
    record.is_continued = !trim_newline(record.text.data(), size) && level == LogLevel::ALL;
}

}  // namespace

struct Log::Impl {
    Mode mode;
    std::mutex printing;  // only one thread prints at a time; realtime threads never take it
    Sink sink;
    void *context;
    std::array<Record, RECORDS> records;
    std::atomic<std::uint64_t> head{0};  // next ticket of writers
    std::uint64_t tail = 0;              // next ticket to print, under `printing`
    std::atomic<std::uint64_t> lost{0};
    std::uint64_t lost_told = 0;  // under `printing`
    std::atomic<bool> isStopping{false};
    std::thread drainer;
    std::array<char, 4 * TEXT_SIZE> line{};  // begin of a line that the next text continues, under `printing`
    std::size_t line_size = 0;               // under `printing`

    void drain_locked();
    void print_locked(const Record &record);
    void end_line_locked();
};

Log::Log(Mode mode, Sink sink, void *context) : impl_(std::make_unique<Impl>()) {
    impl_->mode = mode;
    impl_->sink = sink != nullptr ? sink : &to_standard_files;
    impl_->context = context;
    for (std::size_t i = 0; i < RECORDS; ++i) {
        impl_->records[i].turn.store(i, std::memory_order_relaxed);
    }
    if (mode == Mode::DRAINED) {
        impl_->drainer = std::thread([this] {
            while (!impl_->isStopping.load(std::memory_order_relaxed)) {
                drain();
                std::this_thread::sleep_for(std::chrono::milliseconds(10));
            }
        });
    }
}

Log::~Log() {
    if (impl_->drainer.joinable()) {
        impl_->isStopping.store(true, std::memory_order_relaxed);
        impl_->drainer.join();
    }
    drain();
    impl_->end_line_locked();
}

void Log::print(LogLevel level, const char *format, ...) noexcept {
    std::va_list args;
    va_start(args, format);
    vprint(level, format, args);
    va_end(args);
}

void Log::vprint(LogLevel level, const char *format, std::va_list args) noexcept {
    if (level != LogLevel::NONE && level <= this->level()) {
        vprint_always(level, format, args);
    }
}

void Log::vprint_always(LogLevel level, const char *format, std::va_list args) noexcept {
    std::uint64_t ticket = impl_->head.load(std::memory_order_relaxed);
    Record *record = nullptr;
    // A ticket is taken only for a free slot, so a full ring loses the newest record and never waits. Each
    // failed exchange means that another writer succeeded, so the number of writers bounds the loop.
    while (true) {
        record = &impl_->records[ticket % RECORDS];
        // Acquire: pairs with the drainer's release; the text has been printed before it is overwritten.
        const std::uint64_t turn = record->turn.load(std::memory_order_acquire);
        if (turn < ticket) {
            impl_->lost.fetch_add(1, std::memory_order_relaxed);
            return;
        }
        if (turn == ticket &&
            impl_->head.compare_exchange_weak(ticket, ticket + 1, std::memory_order_relaxed)) {
            break;
        }
        if (turn > ticket) {
            ticket = impl_->head.load(std::memory_order_relaxed);
        }
    }
    fill(*record, level, format, args);
    // Release: pairs with the drainer's acquire; a thread that sees the turn sees the text.
    record->turn.store(ticket + 1, std::memory_order_release);
    if (impl_->mode == Mode::SYNCHRONOUS) {
        drain();
    }
}

void Log::Impl::end_line_locked() {
    if (line_size > 0) {
        line[line_size] = '\0';
        line_size = 0;
        sink(context, LogLevel::ALL, line.data());
    }
}

void Log::Impl::print_locked(const Record &record) {
    if (record.level != LogLevel::ALL || (line_size == 0 && !record.is_continued)) {
        sink(context, record.level, record.text.data());
        return;
    }
    const std::size_t size = std::strlen(record.text.data());
    if (line_size + size >= line.size()) {
        end_line_locked();
    }
    std::memcpy(line.data() + line_size, record.text.data(), size);
    line_size += size;
    if (!record.is_continued) {
        end_line_locked();
    }
}

void Log::Impl::drain_locked() {
    while (true) {
        Record &record = records[tail % RECORDS];
        if (record.turn.load(std::memory_order_acquire) != tail + 1) {
            break;
        }
        print_locked(record);
        record.turn.store(tail + RECORDS, std::memory_order_release);
        ++tail;
    }
    const std::uint64_t now_lost = lost.load(std::memory_order_relaxed);
    if (now_lost != lost_told) {
        char text[80];
        std::snprintf(text, sizeof text, "log: %llu messages were lost",
                      static_cast<unsigned long long>(now_lost - lost_told));
        lost_told = now_lost;
        sink(context, LogLevel::WARN, text);
    }
}

void Log::drain() {
    const std::lock_guard lock(impl_->printing);
    impl_->drain_locked();
}

std::uint64_t Log::lost() const noexcept {
    return impl_->lost.load(std::memory_order_relaxed);
}

void Log::swap_sink(Sink &sink, void *&context) {
    const std::lock_guard lock(impl_->printing);
    impl_->drain_locked();
    std::swap(impl_->sink, sink);
    std::swap(impl_->context, context);
    if (impl_->sink == nullptr) {
        impl_->sink = &to_standard_files;
    }
}

}  // namespace mw::runtime
