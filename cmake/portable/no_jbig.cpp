// Stands in for libjbig where the wheel and the tarball carry libtiff: libjbig is under the GPL,
// which would then be the licence of the whole. Faxes compressed by JBIG (compression 34661 of
// TIFF) cannot be read with it, and libtiff says so with the sentence below. It defines the
// functions that libtiff calls, and touches nothing that they are given.
extern "C" {

[[gnu::visibility("default")]] void jbg_dec_init(void*) {}
[[gnu::visibility("default")]] void jbg_dec_free(void*) {}
[[gnu::visibility("default")]] int jbg_newlen(unsigned char*, unsigned long) { return 0; }
/// Anything but 0 is a failure.
[[gnu::visibility("default")]] int jbg_dec_in(void*, unsigned char*, unsigned long,
                                              unsigned long*) {
  return 1;
}
[[gnu::visibility("default")]] unsigned long jbg_dec_getsize(const void*) { return 0; }
[[gnu::visibility("default")]] unsigned char* jbg_dec_getimage(const void*, int) { return nullptr; }
[[gnu::visibility("default")]] const char* jbg_strerror(int) { return "this build reads no JBIG"; }

// Kaustik writes none.
[[gnu::visibility("default")]] void jbg_enc_init(void*, unsigned long, unsigned long, int,
                                                 unsigned char**,
                                                 void (*)(unsigned char*, unsigned long, void*),
                                                 void*) {}
[[gnu::visibility("default")]] void jbg_enc_out(void*) {}
[[gnu::visibility("default")]] void jbg_enc_free(void*) {}
}
