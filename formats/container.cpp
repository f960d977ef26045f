#include "formats/container.h"
