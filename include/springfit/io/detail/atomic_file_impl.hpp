// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <atomic>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <system_error>
#include <utility>

#include <fcntl.h>
#include <signal.h>
#include <unistd.h>

#include <springfit/io/atomic_file.hpp>

namespace springfit::io {

namespace detail {

[[nodiscard]] inline std::string reason(int error) {
    return std::generic_category().message(error);
}

/// An open POSIX file that is closed on every way out.
class Descriptor {
public:
    Descriptor(const std::filesystem::path& path, int flags)
        : m_descriptor(::open(path.c_str(), flags | O_CLOEXEC, 0666)) {}
    Descriptor(const Descriptor&) = delete;
    Descriptor& operator=(const Descriptor&) = delete;
    ~Descriptor() {
        if (m_descriptor >= 0) {
            ::close(m_descriptor);
        }
    }
    [[nodiscard]] bool is_open() const noexcept { return m_descriptor >= 0; }
    [[nodiscard]] int get() const noexcept { return m_descriptor; }
    /// Closes and says whether that went well: some file systems report a failed write only then.
    [[nodiscard]] bool close() noexcept { return ::close(std::exchange(m_descriptor, -1)) == 0; }

private:
    int m_descriptor;
};

/// The name of this machine: process numbers of another one, on a shared disk, mean nothing here.
[[nodiscard]] inline std::string host_name() {
    std::array<char, 256> name{};
    return ::gethostname(name.data(), name.size() - 1) == 0 ? std::string(name.data()) : std::string("host");
}

/// `.model.json.`, with which the hidden names beside `model.json` begin.
[[nodiscard]] inline std::string hidden_beginning(const std::filesystem::path& target) {
    return text('.', target.filename().string(), '.');
}

/// A hidden name beside `target` that no other file has at the time, `.model.json.4711-0.host.partial`.
[[nodiscard]] inline std::filesystem::path name_beside(const std::filesystem::path& target, std::string_view ending) {
    static std::atomic<unsigned> counter{0};
    for (;;) {
        auto name = target;
        name.replace_filename(
            text(hidden_beginning(target), ::getpid(), '-', counter.fetch_add(1), '.', host_name(), '.', ending));
        std::error_code error;
        if (std::filesystem::symlink_status(name, error).type() == std::filesystem::file_type::not_found || error) {
            return name;
        }
    }
}

/// Removes the temporary files of `target` whose process on this machine lives no more: those of runs that were killed.
inline void remove_leftovers(const std::filesystem::path& target) {
    const std::string beginning = hidden_beginning(target);
    const std::string ending = text('.', host_name(), ".partial");
    const auto folder = target.parent_path();
    std::error_code error;
    for (std::filesystem::directory_iterator entry(folder.empty() ? "." : folder, error), end; !error && entry != end;
         entry.increment(error)) {
        const std::string name = entry->path().filename().string();
        if (!name.starts_with(beginning) || !name.ends_with(ending) ||
            name.size() <= beginning.size() + ending.size()) {
            continue;
        }
        const std::string number = name.substr(beginning.size(), name.size() - beginning.size() - ending.size());
        pid_t process = 0;
        const char* const last = number.data() + number.size();
        const auto [after, problem] = std::from_chars(number.data(), last, process);
        if (problem == std::errc{} && after != last && *after == '-' && process > 0 && ::kill(process, 0) != 0 &&
            errno == ESRCH) {
            ::unlink(entry->path().c_str());
        }
    }
}

inline void write_all(Descriptor& descriptor, std::string_view content, const std::filesystem::path& target) {
    while (!content.empty()) {
        const ssize_t written = ::write(descriptor.get(), content.data(), content.size());
        if (written < 0 && errno == EINTR) {
            continue;
        }
        if (written <= 0) {
            throw FileError(target.string(), text("cannot be written: ", reason(written < 0 ? errno : ENOSPC)));
        }
        content.remove_prefix(static_cast<std::size_t>(written));
    }
}

} // namespace detail

inline std::filesystem::path OutputGroup::add(const std::filesystem::path& target) {
    std::error_code error;
    if (std::filesystem::is_directory(target, error)) {
        throw FileError(target.string(), "cannot be written: it is a folder");
    }
    for (const File& file : m_files) {
        require(file.target != target, "output file", "a name that is not in the group yet", target.string());
    }
    detail::remove_leftovers(target);
    auto temporary = detail::name_beside(target, "partial");
    detail::Descriptor descriptor(temporary, O_WRONLY | O_CREAT | O_EXCL);
    if (!descriptor.is_open()) {
        throw FileError(target.string(), text("cannot be created: ", detail::reason(errno)));
    }
    m_files.push_back({target, temporary, {}, false});
    return temporary;
}

inline void OutputGroup::write(const std::filesystem::path& target, std::string_view content) {
    const auto temporary = add(target);
    detail::Descriptor descriptor(temporary, O_WRONLY);
    if (!descriptor.is_open()) {
        throw FileError(target.string(), text("cannot be written: ", detail::reason(errno)));
    }
    detail::write_all(descriptor, content, target);
    if (!descriptor.close()) {
        throw FileError(target.string(), text("cannot be written: ", detail::reason(errno)));
    }
}

inline void OutputGroup::remove(const std::filesystem::path& target) {
    for (const File& file : m_files) {
        require(file.target != target, "output file", "a name that is not in the group yet", target.string());
    }
    detail::remove_leftovers(target);
    m_files.push_back({target, {}, {}, false});
}

inline void OutputGroup::flush() const {
    for (const File& file : m_files) {
        if (file.temporary.empty()) {
            continue;
        }
        const detail::Descriptor descriptor(file.temporary, O_RDONLY);
        if (!descriptor.is_open() || ::fsync(descriptor.get()) != 0) {
            throw FileError(file.target.string(), text("cannot be written: ", detail::reason(errno)));
        }
    }
}

inline void OutputGroup::back_up(File& file) const {
    std::error_code error;
    const auto status = std::filesystem::symlink_status(file.target, error);
    if (!std::filesystem::exists(status)) {
        return;
    }
    if (std::filesystem::is_directory(status)) {
        throw FileError(file.target.string(), "cannot be written: it is a folder");
    }
    const auto backup = detail::name_beside(file.target, "previous");
    // A second name keeps the old file in place until the new one replaces it; not every file system has them.
    if (::link(file.target.c_str(), backup.c_str()) != 0 && ::rename(file.target.c_str(), backup.c_str()) != 0) {
        throw FileError(file.target.string(), text("cannot be replaced: ", detail::reason(errno)));
    }
    file.backup = backup;
}

inline void OutputGroup::commit() {
    try {
        flush();
        for (File& file : m_files) {
            back_up(file);
            const bool removes = file.temporary.empty();
            if (removes ? ::unlink(file.target.c_str()) != 0 && errno != ENOENT
                        : ::rename(file.temporary.c_str(), file.target.c_str()) != 0) {
                throw FileError(file.target.string(), text("cannot be written: ", detail::reason(errno)));
            }
            file.renamed = true;
        }
    } catch (...) {
        roll_back();
        discard();
        throw;
    }
    for (const File& file : m_files) {
        if (!file.backup.empty()) {
            ::unlink(file.backup.c_str());
        }
        const auto folder = file.target.parent_path();
        const detail::Descriptor descriptor(folder.empty() ? "." : folder, O_RDONLY);
        if (descriptor.is_open()) {
            (void)::fsync(descriptor.get()); // the new names, too; not every file system can
        }
    }
    m_files.clear();
}

inline void OutputGroup::roll_back() noexcept {
    for (File& file : m_files) {
        if (!file.backup.empty()) {
            // Does nothing where both names are the same file still; then the second name is one too many.
            ::rename(file.backup.c_str(), file.target.c_str());
            ::unlink(file.backup.c_str());
        } else if (file.renamed) {
            ::unlink(file.target.c_str());
        }
    }
}

inline void OutputGroup::discard() noexcept {
    for (const File& file : m_files) {
        if (!file.renamed && !file.temporary.empty()) {
            ::unlink(file.temporary.c_str());
        }
    }
    m_files.clear();
}

inline OutputFolder::OutputFolder(std::filesystem::path path) : m_path(std::move(path)) {
    require(!m_path.empty(), "output folder", "a name", "none");
    std::error_code error;
    auto missing = std::filesystem::absolute(m_path, error).lexically_normal();
    if (!missing.has_filename()) {
        missing = missing.parent_path(); // a trailing slash
    }
    std::vector<std::filesystem::path> to_create;
    while (!missing.empty() && !std::filesystem::exists(missing, error)) {
        to_create.push_back(missing);
        missing = missing.parent_path();
    }
    if (!std::filesystem::is_directory(missing, error)) {
        throw FileError(m_path.string(), missing == std::filesystem::absolute(m_path, error).lexically_normal()
                                             ? "cannot be the output folder: it is a file"
                                             : text("cannot be the output folder: ", missing.string(), " is a file"));
    }
    for (auto folder = to_create.rbegin(); folder != to_create.rend(); ++folder) {
        if (!std::filesystem::create_directory(*folder, error) && error) {
            remove_empty();
            throw FileError(m_path.string(), text("cannot be created: ", error.message()));
        }
        m_created.push_back(*folder);
    }
    try {
        OutputGroup trial;
        trial.write(m_path / "trial", "springfit"); // never gets its name
    } catch (const FileError& trial_error) {
        remove_empty();
        const std::string what = trial_error.what();
        throw FileError(m_path.string(), text("cannot be written to", what.substr(what.rfind(": "))));
    }
}

inline void OutputFolder::remove_empty() noexcept {
    for (auto folder = m_created.rbegin(); folder != m_created.rend(); ++folder) {
        ::rmdir(folder->c_str());
    }
    m_created.clear();
}

} // namespace springfit::io
