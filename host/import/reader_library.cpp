#include "host/import/reader_library.hpp"

namespace host {

const LibraryName kMatio{AXIS_MATIO_FILE, AXIS_MATIO_PACKAGE}, kHdf5{AXIS_HDF5_FILE, AXIS_HDF5_PACKAGE},
    kSqlite{AXIS_SQLITE_FILE, AXIS_SQLITE_PACKAGE}, kLz4{AXIS_LZ4_FILE, AXIS_LZ4_PACKAGE},
    kZstd{AXIS_ZSTD_FILE, AXIS_ZSTD_PACKAGE};

}  // namespace host
