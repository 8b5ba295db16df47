/* dem.c - for those who would rather compile a .c file: the implementation of dem.h. */
#define DEM_IMPLEMENTATION
#include "dem.h"
