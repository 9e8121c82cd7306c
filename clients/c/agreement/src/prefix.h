/* Names of the functions of a file that is compiled as C and as C++ under two prefixes. */
#ifndef PREFIX_H
#define PREFIX_H

#include <stddef.h>

#define JOIN_(a, b) a##b
#define JOIN(a, b) JOIN_(a, b)
#define NAME(name) JOIN(PREFIX, name)

#ifdef __cplusplus
#define EXPORT extern "C"
#else
#define EXPORT extern
#endif

#endif
