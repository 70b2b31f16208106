# SPDX-License-Identifier: BSD-3-Clause
# The list of what a build holds besides Carrom's own code, in CycloneDX's form, for those who have
# to know it of what they install (https://cyclonedx.org/docs/1.5/json/). Versions are those that
# CMake found. Random123 has none in its headers; for MPI and OpenMP they are the standard's.

set(sbom_parts "")
# sbom_part(NAME VERSION LICENCE): by its SPDX name, or none where that depends on who provides it
function(sbom_part name version licence)
  set(part "{\"type\": \"library\", \"bom-ref\": \"${name}\", \"name\": \"${name}\"")
  if(version)
    string(APPEND part ", \"version\": \"${version}\"")
  endif()
  if(licence)
    string(APPEND part ", \"licenses\": [{\"license\": {\"id\": \"${licence}\"}}]")
  endif()
  set(sbom_parts ${sbom_parts} "    ${part}}" PARENT_SCOPE)
endfunction()

sbom_part(fmt "${fmt_VERSION}" MIT)
sbom_part(tomlplusplus "${tomlplusplus_VERSION}" MIT)
sbom_part(highway "${hwy_VERSION}" Apache-2.0)
sbom_part(xxhash "${xxhash_VERSION}" BSD-2-Clause)
sbom_part(random123 "" BSD-3-Clause)
sbom_part(CLI11 "${CLI11_VERSION}" BSD-3-Clause)
sbom_part(nlohmann_json "${nlohmann_json_VERSION}" MIT)
sbom_part(hdf5 "${HDF5_VERSION}" "")
sbom_part(mpi "${MPI_C_VERSION}" "")
sbom_part(openmp "${OpenMP_CXX_VERSION}" "")

list(JOIN sbom_parts ",\n" sbom_components)
file(WRITE ${PROJECT_BINARY_DIR}/carrom.cdx.json "{
  \"bomFormat\": \"CycloneDX\",
  \"specVersion\": \"1.5\",
  \"version\": 1,
  \"metadata\": {
    \"component\": {\"type\": \"application\", \"bom-ref\": \"carrom\", \"name\": \"carrom\",
                  \"version\": \"${PROJECT_VERSION}\",
                  \"licenses\": [{\"license\": {\"id\": \"BSD-3-Clause\"}}]}
  },
  \"components\": [
${sbom_components}
  ]
}
")
install(FILES ${PROJECT_BINARY_DIR}/carrom.cdx.json DESTINATION ${CMAKE_INSTALL_DOCDIR})
