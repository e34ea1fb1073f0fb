// SPDX-License-Identifier: GPL-2.0-or-later
// Tests that programs are listed, arrive in pieces, completely or not at all, and that no other files are
// accessible (J3).
#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include <gtest/gtest.h>

#include "base/atomic_file.hh"
#include "clients/screen/files/files.hh"

namespace mw::screen {
namespace {

namespace fs = std::filesystem;

class ProgramFilesTest : public testing::Test {
  protected:
    ProgramFilesTest() {
        const auto *info = testing::UnitTest::GetInstance()->current_test_info();
        base_ = fs::temp_directory_path() /
                (std::string("mw_files_") + info->name() + std::to_string(::getpid()));
        folder_ = base_ / "programs";
        fs::create_directories(folder_);
        files_.emplace(folder_.string(), std::vector<std::string>{".ngc", ".nc"});
    }
    ~ProgramFilesTest() override {
        files_.reset();
        fs::remove_all(base_);
    }
    void put(const fs::path &name, const std::string &text) const { std::ofstream(folder_ / name) << text; }
    std::vector<std::string> listed() const {
        std::vector<std::string> names;
        const auto list = nlohmann::json::parse(files_->list().body);
        for (const auto &one : list.at("files")) {
            names.push_back(one["name"]);
        }
        return names;
    }
    std::size_t count_entries() const {
        return static_cast<std::size_t>(
            std::distance(fs::directory_iterator(folder_), fs::directory_iterator()));
    }

    fs::path base_, folder_;
    std::optional<ProgramFiles> files_;
};

TEST_F(ProgramFilesTest, ProgramsAreListedAndNothingElse) {
    put("b.ngc", "G0\n");
    put("A.NC", "");
    put("notes.txt", "");
    put(".hidden.ngc", "");
    fs::create_directory(folder_ / "folder.ngc");
    EXPECT_EQ(listed(), (std::vector<std::string>{"A.NC", "b.ngc"}));
    const auto first = nlohmann::json::parse(files_->list().body)["files"][1];
    EXPECT_EQ(first["size"], 3);
    EXPECT_GT(first["modified_s"], 1600000000);
}

TEST_F(ProgramFilesTest, AFileHasItsNameWithTheLastPiece) {
    put("p.ngc", "old");
    EXPECT_EQ(files_->write("p.ngc", 0, 9, "G0 X1").status, 200);
    EXPECT_EQ(files_->read("p.ngc").body, "old");
    EXPECT_EQ(files_->write("p.ngc", 5, 9, "\nM2\n").status, 200);
    EXPECT_EQ(files_->read("p.ngc").body, "G0 X1\nM2\n");
    EXPECT_EQ(count_entries(), 2U) << "the program and its former version";
    EXPECT_EQ(files_->write("empty.ngc", 0, 0, "").status, 200);
    EXPECT_EQ(files_->read("empty.ngc").status, 200);
}

TEST_F(ProgramFilesTest, TheFormerVersionIsKept) {
    EXPECT_EQ(files_->read_former("p.ngc").status, 404);
    EXPECT_EQ(files_->write("p.ngc", 0, 3, "one").status, 200);
    EXPECT_EQ(files_->read_former("p.ngc").status, 404) << "nothing was replaced";
    EXPECT_EQ(files_->write("p.ngc", 0, 3, "two").status, 200);
    EXPECT_EQ(files_->read_former("p.ngc").body, "one");
    EXPECT_EQ(files_->write("p.ngc", 0, 5, "three").status, 200);
    EXPECT_EQ(files_->read_former("p.ngc").body, "two");
    EXPECT_EQ(files_->read("p.ngc").body, "three");
    EXPECT_EQ(listed(), std::vector<std::string>{"p.ngc"});
    EXPECT_EQ(count_entries(), 2U);
}

TEST_F(ProgramFilesTest, ASaveWithoutAChangeKeepsTheFormerVersion) {
    EXPECT_EQ(files_->write("p.ngc", 0, 3, "one").status, 200);
    EXPECT_EQ(files_->write("p.ngc", 0, 3, "two").status, 200);
    EXPECT_EQ(files_->write("p.ngc", 0, 3, "two").status, 200);
    EXPECT_EQ(files_->read_former("p.ngc").body, "one");
    const std::string large(400'000, 'a');
    EXPECT_EQ(files_->write("p.ngc", 0, large.size(), large).status, 200);
    EXPECT_EQ(files_->write("p.ngc", 0, large.size(), large).status, 200);
    EXPECT_EQ(files_->read_former("p.ngc").body, "two");
    std::string other = large;
    other.back() = 'b';
    EXPECT_EQ(files_->write("p.ngc", 0, other.size(), other).status, 200);
    EXPECT_EQ(files_->write("p.ngc", 0, 1, "x").status, 200);
    EXPECT_EQ(fs::file_size(folder_ / "p.ngc~"), other.size());
}

TEST_F(ProgramFilesTest, ASaveLeavesOtherFilesAsTheyAre) {
    put("p.ngc", "one");
    put("p.ngc~~", "of a person");
    EXPECT_EQ(files_->write("p.ngc", 0, 3, "two").status, 200);
    EXPECT_EQ(fs::file_size(folder_ / "p.ngc~~"), 11U);
}

TEST_F(ProgramFilesTest, ASaveThatWasInterruptedAfterItsFormerVersionCanBeRepeated) {
    put("p.ngc", "one");
    fs::create_hard_link(folder_ / "p.ngc", folder_ / "p.ngc~");
    EXPECT_EQ(files_->write("p.ngc", 0, 3, "two").status, 200);
    EXPECT_EQ(files_->read_former("p.ngc").body, "one");
    EXPECT_EQ(files_->read("p.ngc").body, "two");
    EXPECT_EQ(count_entries(), 2U);
}

TEST_F(ProgramFilesTest, NothingIsSavedIfTheFormerVersionCannotBeKept) {
    put("p.ngc", "one");
    fs::create_directories(folder_ / "p.ngc~" / "full");
    const Response refused = files_->write("p.ngc", 0, 3, "two");
    EXPECT_EQ(refused.status, 403);
    EXPECT_NE(refused.body.find("former version"), std::string::npos);
    EXPECT_EQ(files_->read("p.ngc").body, "one");
}

TEST_F(ProgramFilesTest, APieceThatDoesNotFitOnIsRefused) {
    EXPECT_EQ(files_->write("p.ngc", 3, 9, "abc").status, 409);
    EXPECT_EQ(files_->write("p.ngc", 0, 9, "abc").status, 200);
    EXPECT_EQ(files_->write("p.ngc", 2, 9, "abc").status, 409);
    EXPECT_EQ(files_->write("p.ngc", 3, 8, "abc").status, 409);  // a piece of another file
    EXPECT_EQ(files_->write("p.ngc", 8, 9, "abc").status, 400);  // longer than announced
    EXPECT_EQ(files_->write("p.ngc", 3, 9, "defghi").status, 200);
    EXPECT_EQ(files_->read("p.ngc").body, "abcdefghi");
    EXPECT_EQ(files_->write("p.ngc", 0, ProgramFiles::MOST_BYTES + 1, "a").status, 400);
    EXPECT_EQ(files_->write("p.ngc", ~std::uint64_t{0}, ~std::uint64_t{0}, "a").status, 400);
}

TEST_F(ProgramFilesTest, WhatIsNotWholeLeavesNothing) {
    for (int i = 0; i < 20; ++i) {
        EXPECT_EQ(files_->write(std::to_string(i) + ".ngc", 0, 9, "abc").status, 200);
    }
    EXPECT_EQ(count_entries(), ProgramFiles::MOST_UPLOADS);
    EXPECT_EQ(files_->write("0.ngc", 3, 9, "defghi").status, 409);  // the oldest uploads are abandoned
    EXPECT_TRUE(listed().empty());
    files_.reset();
    EXPECT_EQ(count_entries(), 0U);
}

TEST_F(ProgramFilesTest, RemovesUploadsOfADeadServerAndNothingElse) {
    EXPECT_EQ(files_->write("p.ngc", 0, 9, "abc").status, 200);
    std::string upload;
    for (const auto &entry : fs::directory_iterator(folder_)) {
        upload = entry.path().filename().string();
    }
    ASSERT_TRUE(upload.starts_with(".p.ngc.millwright-"));
    const auto with_last = [&upload](std::size_t n) {  // another name of the same length
        std::string letters = "abcd";
        std::erase(letters, upload.back());
        return upload.substr(0, upload.size() - 1) + letters[n];
    };
    const std::string dead = with_last(0);
    put(dead, "abc");
    put(upload + "x", "another file");
    put(".notes", "another file");
    fs::create_hard_link(folder_ / ".notes", folder_ / with_last(1));
    fs::create_symlink(folder_ / ".notes", folder_ / with_last(2));
    const std::size_t before = count_entries();
    const ProgramFiles next(folder_.string(), {".ngc"});
    EXPECT_FALSE(fs::exists(folder_ / dead));
    EXPECT_EQ(count_entries(), before - 1) << "links and other names stay";
    EXPECT_EQ(files_->write("p.ngc", 3, 9, "defghi").status, 200) << "the server that lives continues";
    EXPECT_EQ(files_->read("p.ngc").body, "abcdefghi");
}

TEST_F(ProgramFilesTest, ALargeProgramIsReadInPieces) {
    std::string text(3 * BodySource::PIECE + 17, ' ');
    for (std::size_t i = 0; i < text.size(); i += 80) {
        text[i] = static_cast<char>('a' + i % 26);
    }
    put("large.ngc", text);
    const Response answer = files_->read("large.ngc");
    EXPECT_TRUE(answer.body.empty());
    ASSERT_NE(answer.source, nullptr);
    EXPECT_EQ(answer.source->size(), text.size());
    std::string read;
    for (std::string piece = answer.source->read(); !piece.empty(); piece = answer.source->read()) {
        EXPECT_LE(piece.size(), BodySource::PIECE);
        read += piece;
    }
    EXPECT_EQ(read, text);
    EXPECT_EQ(::mkfifo((folder_ / "pipe.ngc").c_str(), 0600), 0);
    EXPECT_EQ(files_->read("pipe.ngc").status, 404);
}

TEST_F(ProgramFilesTest, NothingBesideTheProgramsIsReached) {
    std::ofstream(base_ / "secret.ngc") << "secret";
    for (const char *name : {"../secret.ngc", "..", ".", "", "/etc/passwd", ".x.ngc", "a/b.ngc", "x.sh",
                             ".ngc", "a\\b.ngc", "a\nb.ngc"}) {
        EXPECT_EQ(files_->read(name).status, 400) << name;
        EXPECT_EQ(files_->write(name, 0, 1, "x").status, 400) << name;
        EXPECT_EQ(files_->remove(name).status, 400) << name;
    }
    EXPECT_EQ(*read_file((base_ / "secret.ngc").string()), "secret");
}

TEST_F(ProgramFilesTest, AnUploadIsNeverAProgramOfTheSystem) {
    put("run.ngc", "#!/bin/sh\n");
    ASSERT_EQ(::chmod((folder_ / "run.ngc").c_str(), 0755), 0);
    EXPECT_EQ(files_->write("run.ngc", 0, 1, "x").status, 200);
    struct stat facts{};
    ASSERT_EQ(::stat((folder_ / "run.ngc").c_str(), &facts), 0);
    EXPECT_EQ(facts.st_mode & 0777, 0644U);
}

TEST_F(ProgramFilesTest, AProgramIsRemovedOnce) {
    put("p.ngc", "");
    EXPECT_EQ(files_->remove("p.ngc").status, 200);
    EXPECT_EQ(files_->remove("p.ngc").status, 404);
    EXPECT_EQ(files_->read("p.ngc").status, 404);
}

TEST_F(ProgramFilesTest, ThePagesOfTheScreenAreServedAndNothingElse) {
    fs::create_directories(folder_ / "assets");
    put("index.html", "<!doctype html>");
    put("assets/a-1.js", "1");
    put(".secret", "x");
    std::ofstream(base_ / "secret") << "x";
    const std::string folder = folder_.string();
    EXPECT_EQ(screen_file(folder, "/").body, "<!doctype html>");
    EXPECT_EQ(screen_file(folder, "/").type, "text/html; charset=utf-8");
    EXPECT_FALSE(screen_file(folder, "/").isKept);
    EXPECT_EQ(screen_file(folder, "/assets/a-1.js").type, "text/javascript; charset=utf-8");
    EXPECT_TRUE(screen_file(folder, "/assets/a-1.js").isKept);
    for (const char *path : {"/../secret", "/.secret", "/assets", "/assets/", "/assets/../.secret",
                             "//etc/passwd", "/assets//a-1.js"}) {
        EXPECT_EQ(screen_file(folder, path).status, 404) << path;
    }
}

}  // namespace
}  // namespace mw::screen
