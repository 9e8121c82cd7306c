// The DirectX Shader Compiler by its library alone: dxc LIBRARY FILE ARGUMENTS... Prints what the
// compiler says, and the size of what it makes. Exit status 1 if it makes nothing.
#include <dlfcn.h>

#include <cstdio>
#include <string>
#include <vector>

#include "WinAdapter.h"
#include "dxcapi.h"

template <class T> static T *made(HRESULT status, T *it, const char *what)
{
    if (SUCCEEDED(status)) return it;
    std::fprintf(stderr, "error: %s: %x\n", what, static_cast<unsigned>(status));
    std::exit(1);
}

int main(int count, char **arguments)
{
    if (count < 3) return std::fprintf(stderr, "usage: dxc LIBRARY FILE ARGUMENTS...\n"), 2;
    void *const library = dlopen(arguments[1], RTLD_NOW);
    if (!library) return std::fprintf(stderr, "error: %s\n", dlerror()), 1;
    const auto create =
        reinterpret_cast<DxcCreateInstanceProc>(dlsym(library, "DxcCreateInstance"));
    std::vector<std::wstring> words;
    for (int i = 2; i < count; ++i) {
        const std::string word = arguments[i];
        words.emplace_back(word.begin(), word.end());
    }
    std::vector<LPCWSTR> pointers;
    for (const auto &word : words) pointers.push_back(word.c_str());

    IDxcUtils *utils;
    IDxcCompiler3 *compiler;
    IDxcIncludeHandler *includes;
    IDxcBlobEncoding *text;
    IDxcResult *result;
    IDxcBlobUtf8 *said = nullptr;
    IDxcBlob *object = nullptr;
    made(create(CLSID_DxcUtils, __uuidof(IDxcUtils), reinterpret_cast<void **>(&utils)), utils,
         "no utilities");
    made(create(CLSID_DxcCompiler, __uuidof(IDxcCompiler3), reinterpret_cast<void **>(&compiler)),
         compiler, "no compiler");
    made(utils->CreateDefaultIncludeHandler(&includes), includes, "no includes");
    made(utils->LoadFile(words[0].c_str(), nullptr, &text), text, arguments[2]);
    const DxcBuffer source = {text->GetBufferPointer(), text->GetBufferSize(), DXC_CP_UTF8};
    made(compiler->Compile(&source, pointers.data(), static_cast<UINT32>(pointers.size()), includes,
                           __uuidof(IDxcResult), reinterpret_cast<void **>(&result)),
         result, "no result");

    result->GetOutput(DXC_OUT_ERRORS, __uuidof(IDxcBlobUtf8), reinterpret_cast<void **>(&said),
                      nullptr);
    if (said && said->GetStringLength()) std::fputs(said->GetStringPointer(), stderr);
    result->GetOutput(DXC_OUT_OBJECT, __uuidof(IDxcBlob), reinterpret_cast<void **>(&object),
                      nullptr);
    HRESULT status = E_FAIL;
    result->GetStatus(&status);
    const size_t size = SUCCEEDED(status) && object ? object->GetBufferSize() : 0;
    std::printf("%s: %zu bytes\n", arguments[2], size);
    return size ? 0 : 1;
}
