# Turns INPUT into a C source OUTPUT that defines SYMBOL (its bytes, a zero after them) and SYMBOL_size, as HEADER
# declares them. Run as: cmake -D INPUT=... -D OUTPUT=... -D SYMBOL=... -D HEADER=... -P embed_file.cmake
file(READ "${INPUT}" bytes HEX)
string(LENGTH "${bytes}" digit_count)
math(EXPR size "${digit_count} / 2")
string(REPEAT "[0-9a-f]" 32 sixteen_bytes)
string(REGEX REPLACE "(${sixteen_bytes})" "\\1\n    " bytes "${bytes}")
string(REGEX REPLACE "([0-9a-f][0-9a-f])" "0x\\1, " bytes "${bytes}")
string(REPLACE ", \n" ",\n" bytes "${bytes}")
get_filename_component(name "${INPUT}" NAME)
file(WRITE "${OUTPUT}" "/* Made from ${name} by the build. */
#include \"${HEADER}\"

const unsigned char ${SYMBOL}[] = {
    ${bytes}0x00};
const size_t ${SYMBOL}_size = ${size};
")
