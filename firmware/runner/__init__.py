"""What `firmware/run` is made of: a module for each thing that is done with an image.

Data enters through `chips` (what is built and where it runs) and `benches/`; `build` makes an ELF
file, `elf` reads it, `qemu` runs it, and the others judge what came out. Standard library only.
"""
