// SPDX-License-Identifier: GPL-3.0-or-later
#include "engine/reports/xapi_origin.h"

#include <map>

#include "engine/live/catalogue.h"
#include "engine/live/project_folder.h"

namespace insula {

xapi::Origin xapi_origin(const training::Outbox& outbox) {
  std::map<std::string, std::string> texts;
  for (const CatalogueEntry& e : catalogue(project_folder())) texts[e.scene] = e.text;
  return {outbox.home_page(), [texts = std::move(texts)](const std::string& scene) {
            const auto found = texts.find(scene);
            return found == texts.end() ? std::string() : found->second;
          }};
}

}  // namespace insula
