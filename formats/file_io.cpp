#include "formats/file_io.h"
