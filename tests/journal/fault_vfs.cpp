#include "tests/journal/fault_vfs.hpp"

#include <sqlite3.h>

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <map>
#include <new>
#include <vector>

#include "tests/journal/sample_log.hpp"

namespace earthwork::journal {

namespace {

constexpr std::size_t kSector = 512;

struct File {
  sqlite3_file base;
  FaultVfs* vfs;
  const char* path;    // of SQLite's; null for a temporary file
  sqlite3_file* real;  // stands behind this
};

File& as_file(sqlite3_file* file) { return *reinterpret_cast<File*>(file); }
sqlite3_file* real_of(sqlite3_file* file) { return as_file(file).real; }

}  // namespace

struct FaultVfs::Parts {
  sqlite3_vfs vfs{};
  sqlite3_vfs* real = nullptr;
  sqlite3_io_methods methods{};
  std::map<std::string, std::string> synced;  // while watching: files as of their last sync

  static FaultVfs& self(sqlite3_file* file) { return *as_file(file).vfs; }
  static Parts& of(sqlite3_vfs* vfs) { return *static_cast<FaultVfs*>(vfs->pAppData)->parts_; }

  static int open(sqlite3_vfs* vfs, const char* name, sqlite3_file* file, int flags, int* out) {
    Parts& parts = of(vfs);
    File& f = as_file(file);
    f = {.base = {nullptr},
         .vfs = static_cast<FaultVfs*>(vfs->pAppData),
         .path = name,
         .real = reinterpret_cast<sqlite3_file*>(&f + 1)};
    const int result = parts.real->xOpen(parts.real, name, f.real, flags, out);
    if (f.real->pMethods != nullptr) f.base.pMethods = &parts.methods;
    if (result == SQLITE_OK && f.vfs->watching_ && name != nullptr && !parts.synced.contains(name))
      parts.synced[name] = read_bytes(name);
    return result;
  }
  static int write(sqlite3_file* file, const void* bytes, int size, sqlite3_int64 at) {
    FaultVfs& vfs = self(file);
    if (vfs.dead_) return SQLITE_IOERR_WRITE;
    if (++vfs.writes_ < vfs.full_at_)
      return real_of(file)->pMethods->xWrite(real_of(file), bytes, size, at);
    // As a disk does: some of it may still have found room.
    if (size > 8) real_of(file)->pMethods->xWrite(real_of(file), bytes, size / 2, at);
    return SQLITE_FULL;
  }
  static int truncate(sqlite3_file* file, sqlite3_int64 size) {
    if (self(file).dead_) return SQLITE_IOERR_TRUNCATE;
    return real_of(file)->pMethods->xTruncate(real_of(file), size);
  }
  static int sync(sqlite3_file* file, int flags) {
    FaultVfs& vfs = self(file);
    ++vfs.syncs_;
    const bool failing =
        vfs.syncs_ >= vfs.no_sync_at_ && vfs.syncs_ - vfs.no_sync_at_ < vfs.syncs_failing_;
    if (vfs.dead_ || failing) return SQLITE_IOERR_FSYNC;
    const int result = real_of(file)->pMethods->xSync(real_of(file), flags);
    if (vfs.watching_ && as_file(file).path != nullptr)
      vfs.parts_->synced[as_file(file).path] = read_bytes(as_file(file).path);
    return result;
  }
  static int remove(sqlite3_vfs* vfs, const char* name, int sync_folder) {
    auto& self = *static_cast<FaultVfs*>(vfs->pAppData);
    if (self.dead_) return SQLITE_IOERR_DELETE;
    self.parts_->synced.erase(name);
    return self.parts_->real->xDelete(self.parts_->real, name, sync_folder);
  }

  void fill_methods();
};

void FaultVfs::Parts::fill_methods() {
  methods.iVersion = 2;
  methods.xClose = [](sqlite3_file* f) { return real_of(f)->pMethods->xClose(real_of(f)); };
  methods.xRead = [](sqlite3_file* f, void* to, int size, sqlite3_int64 at) {
    return real_of(f)->pMethods->xRead(real_of(f), to, size, at);
  };
  methods.xWrite = write;
  methods.xTruncate = truncate;
  methods.xSync = sync;
  methods.xFileSize = [](sqlite3_file* f, sqlite3_int64* size) {
    return real_of(f)->pMethods->xFileSize(real_of(f), size);
  };
  methods.xLock = [](sqlite3_file* f, int l) { return real_of(f)->pMethods->xLock(real_of(f), l); };
  methods.xUnlock = [](sqlite3_file* f, int l) {
    return real_of(f)->pMethods->xUnlock(real_of(f), l);
  };
  methods.xCheckReservedLock = [](sqlite3_file* f, int* out) {
    return real_of(f)->pMethods->xCheckReservedLock(real_of(f), out);
  };
  methods.xFileControl = [](sqlite3_file* f, int op, void* arg) {
    return real_of(f)->pMethods->xFileControl(real_of(f), op, arg);
  };
  methods.xSectorSize = [](sqlite3_file* f) {
    return real_of(f)->pMethods->xSectorSize(real_of(f));
  };
  methods.xDeviceCharacteristics = [](sqlite3_file* f) {
    return real_of(f)->pMethods->xDeviceCharacteristics(real_of(f));
  };
  methods.xShmMap = [](sqlite3_file* f, int page, int size, int extend, void volatile** out) {
    const FaultVfs& vfs = self(f);
    if (extend != 0 && vfs.writes_ + 1 >= vfs.full_at_) return SQLITE_FULL;
    return real_of(f)->pMethods->xShmMap(real_of(f), page, size, extend, out);
  };
  methods.xShmLock = [](sqlite3_file* f, int offset, int n, int flags) {
    return real_of(f)->pMethods->xShmLock(real_of(f), offset, n, flags);
  };
  methods.xShmBarrier = [](sqlite3_file* f) { real_of(f)->pMethods->xShmBarrier(real_of(f)); };
  methods.xShmUnmap = [](sqlite3_file* f, int remove) {
    return real_of(f)->pMethods->xShmUnmap(real_of(f), remove);
  };
}

FaultVfs::FaultVfs() : parts_(std::make_unique<Parts>()) {
  parts_->real = sqlite3_vfs_find(nullptr);
  parts_->vfs = *parts_->real;  // what is not replaced takes the real one's state, which is shared
  parts_->vfs.zName = "faulty";
  parts_->vfs.pNext = nullptr;
  parts_->vfs.pAppData = this;
  parts_->vfs.szOsFile = static_cast<int>(sizeof(File)) + parts_->real->szOsFile;
  parts_->vfs.xOpen = Parts::open;
  parts_->vfs.xDelete = Parts::remove;
  parts_->fill_methods();
  sqlite3_vfs_register(&parts_->vfs, 1);
}

FaultVfs::~FaultVfs() { sqlite3_vfs_unregister(&parts_->vfs); }

void FaultVfs::mend() { full_at_ = no_sync_at_ = kNever; }

void FaultVfs::watch() {
  watching_ = true;
  parts_->synced.clear();
}

void FaultVfs::lose_power(Loss loss, std::uint64_t seed) {
  dead_ = true;
  std::mt19937_64 lot(seed);
  for (const auto& [path, synced] : parts_->synced) {
    if (!std::filesystem::exists(path)) continue;  // it has another name now
    std::string now = read_bytes(path);
    std::string after = synced;
    if (loss == Loss::torn) {
      after.resize(std::max(after.size(), now.size()), '\0');
      for (std::size_t at = 0; at < now.size(); at += kSector)
        if (lot() % 2 == 0) after.replace(at, std::min(kSector, now.size() - at), now, at, kSector);
    }
    write_bytes(path, after);
  }
}

}  // namespace earthwork::journal
