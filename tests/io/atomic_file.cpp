// SPDX-License-Identifier: BSD-3-Clause
#include "files.hpp"

#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <springfit/io/atomic_file.hpp>

using namespace springfit;
using namespace springfit::io;
using springfit::test::content;
using springfit::test::file_error;
using springfit::test::FileSizeLimit;
using springfit::test::put;
using springfit::test::ScratchFolder;

namespace {

/// A folder that nobody can write to, not even root.
const std::filesystem::path unwritable = "/proc/self/task";

} // namespace

TEST_CASE("a file appears when it is complete, and replaces what was there") {
    const ScratchFolder folder;
    put(folder / "a.txt", "old");
    {
        OutputGroup outputs;
        outputs.write(folder / "a.txt", "new");
        CHECK(content(folder / "a.txt") == "old");
        outputs.commit();
    }
    CHECK(content(folder / "a.txt") == "new");
    CHECK(folder.names() == std::vector<std::string>{"a.txt"});
    write_file(folder / "b.txt", "");
    CHECK(folder.names() == std::vector<std::string>{"a.txt", "b.txt"});

    struct stat status{};
    REQUIRE(::stat((folder / "b.txt").c_str(), &status) == 0);
    const mode_t mask = ::umask(0);
    ::umask(mask);
    CHECK((status.st_mode & 0777) == (0666 & ~mask));
}

TEST_CASE("a group that is never committed leaves nothing") {
    const ScratchFolder folder;
    {
        OutputGroup outputs;
        outputs.write(folder / "a.txt", "a");
        put(outputs.add(folder / "b.txt"), "b");
        CHECK(folder.names().size() == 2);
        CHECK_THROWS_AS((void)outputs.add(folder / "a.txt"), InvalidArgument);
    }
    CHECK(folder.names().empty());
}

TEST_CASE("when the last file of a group fails, none appears and the old ones are back") {
    const ScratchFolder folder;
    put(folder / "a.txt", "old");
    OutputGroup outputs;
    outputs.write(folder / "a.txt", "new a");
    outputs.write(folder / "b.txt", "new b");
    outputs.write(folder / "c.txt", "new c");
    std::filesystem::create_directory(folder / "c.txt"); // a folder takes the name meanwhile
    put(folder / "c.txt/inside", "x");
    const std::string message = file_error([&] { outputs.commit(); });
    CHECK(message == (folder / "c.txt").string() + ": cannot be written: it is a folder");
    CHECK(folder.names() == std::vector<std::string>{"a.txt", "c.txt"});
    CHECK(content(folder / "a.txt") == "old");
    CHECK(content(folder / "c.txt/inside") == "x");
}

TEST_CASE("what a group is to remove goes when the group appears, and stays where that fails") {
    const ScratchFolder folder;
    put(folder / "stale.txt", "old");
    put(folder / "a.txt", "old");
    {
        OutputGroup outputs;
        outputs.write(folder / "a.txt", "new");
        outputs.remove(folder / "stale.txt");
        CHECK_THROWS_AS(outputs.remove(folder / "a.txt"), InvalidArgument);
    }
    CHECK(folder.names() == std::vector<std::string>{"a.txt", "stale.txt"}); // never committed
    {
        OutputGroup outputs;
        outputs.remove(folder / "stale.txt");
        outputs.write(folder / "a.txt", "new");
        outputs.write(folder / "c.txt", "new");
        std::filesystem::create_directory(folder / "c.txt");
        CHECK_FALSE(file_error([&] { outputs.commit(); }).empty());
        std::filesystem::remove(folder / "c.txt");
    }
    CHECK(folder.names() == std::vector<std::string>{"a.txt", "stale.txt"});
    CHECK(content(folder / "stale.txt") == "old");
    CHECK(content(folder / "a.txt") == "old");
    OutputGroup outputs;
    outputs.write(folder / "a.txt", "new");
    outputs.remove(folder / "stale.txt");
    outputs.remove(folder / "never.txt");
    outputs.commit();
    CHECK(folder.names() == std::vector<std::string>{"a.txt"});
    CHECK(content(folder / "a.txt") == "new");
}

TEST_CASE("what a killed run left is removed by the next, what a living one writes is not") {
    const ScratchFolder folder;
    const auto leave = [&](bool is_killed) {
        int ready[2];
        REQUIRE(::pipe(ready) == 0);
        const pid_t child = ::fork();
        REQUIRE(child >= 0);
        if (child == 0) {
            OutputGroup outputs;
            outputs.write(folder / "a.txt", "half");
            (void)::write(ready[1], "x", 1);
            for (;;) {
                ::pause();
            }
        }
        char byte = 0;
        REQUIRE(::read(ready[0], &byte, 1) == 1);
        ::close(ready[0]);
        ::close(ready[1]);
        if (is_killed) {
            ::kill(child, SIGKILL);
            ::waitpid(child, nullptr, 0);
        }
        return child;
    };
    const pid_t living = leave(false);
    (void)leave(true);
    REQUIRE(folder.names().size() == 2);
    put(folder / ".a.txt.partial", "mine");
    put(folder / ".a.txt.4711.partial", "mine, too");
    put(folder / ".b.txt.1-0.elsewhere.partial", "of another machine");
    CHECK(folder.names().size() == 5);
    write_file(folder / "a.txt", "full");
    CHECK(content(folder / "a.txt") == "full");
    CHECK(folder.names().size() == 5); // one went, one came
    ::kill(living, SIGKILL);
    ::waitpid(living, nullptr, 0);
    write_file(folder / "a.txt", "full");
    CHECK(folder.names() ==
          std::vector<std::string>{".a.txt.4711.partial", ".a.txt.partial", ".b.txt.1-0.elsewhere.partial", "a.txt"});
}

TEST_CASE("a full disk is reported with the name of the file and leaves nothing") {
    const ScratchFolder folder;
    {
        const FileSizeLimit limit(1000);
        OutputGroup outputs;
        outputs.write(folder / "small.txt", "fits");
        const std::string message = file_error([&] { outputs.write(folder / "large.txt", std::string(5000, 'x')); });
        CHECK(message == (folder / "large.txt").string() + ": cannot be written: File too large");
    }
    CHECK(folder.names().empty());
}

TEST_CASE("a name that cannot be written to is refused at once") {
    const ScratchFolder folder;
    std::filesystem::create_directory(folder / "taken");
    CHECK(file_error([&] { write_file(folder / "taken", ""); }) ==
          (folder / "taken").string() + ": cannot be written: it is a folder");
    CHECK(file_error([&] { write_file(folder / "none/a.txt", ""); }) ==
          (folder / "none/a.txt").string() + ": cannot be created: No such file or directory");
    CHECK(file_error([&] {
              write_file(unwritable / "a.txt", "");
          }).starts_with("/proc/self/task/a.txt: cannot be created: "));
}

TEST_CASE("an output folder is created with its parents, and goes again where nothing was put in") {
    const ScratchFolder folder;
    {
        const OutputFolder output(folder / "a/b/c/");
        CHECK(std::filesystem::is_directory(folder / "a/b/c"));
        CHECK(std::filesystem::is_empty(folder / "a/b/c"));
    }
    CHECK(folder.names().empty());
    {
        const OutputFolder output(folder / "a/b");
        write_file(output.path() / "kept.txt", "x");
    }
    CHECK(content(folder / "a/b/kept.txt") == "x");
    {
        const OutputFolder output(folder / "a/b");
    }
    CHECK(content(folder / "a/b/kept.txt") == "x");
}

TEST_CASE("an output folder that is a file or cannot be written to is refused") {
    const ScratchFolder folder;
    CHECK_THROWS_WITH_AS(OutputFolder(""), "output folder: expected a name, found none", InvalidArgument);
    put(folder / "file", "x");
    CHECK(file_error([&] { OutputFolder output(folder / "file"); }) ==
          (folder / "file").string() + ": cannot be the output folder: it is a file");
    CHECK(file_error([&] { OutputFolder output(folder / "file/sub"); }) ==
          (folder / "file/sub").string() + ": cannot be the output folder: " + (folder / "file").string() +
              " is a file");
    CHECK(file_error([&] { OutputFolder output(unwritable); }).starts_with("/proc/self/task: cannot be written to: "));
    CHECK(file_error([&] {
              OutputFolder output(unwritable / "sub");
          }).starts_with("/proc/self/task/sub: cannot be created: "));
    {
        const FileSizeLimit limit(4);
        CHECK(file_error([&] { OutputFolder output(folder / "new/sub"); }) ==
              (folder / "new/sub").string() + ": cannot be written to: File too large");
    }
    CHECK(folder.names() == std::vector<std::string>{"file"});
}
