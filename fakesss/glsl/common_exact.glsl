// EXACT: this value is computed as written. A driver may otherwise fuse or reorder a sum differently in each permutation,
// and a term of no weight would change the last bit by its mere presence. Where there is no such word, it may.
#ifdef GL_ARB_gpu_shader5
#extension GL_ARB_gpu_shader5 : enable
#define EXACT precise
#else
#define EXACT
#endif
